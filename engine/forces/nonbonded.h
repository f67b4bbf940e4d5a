// Lennard-Jones and Coulomb of a topology in double: over all pairs, the reference that faster ways
// of summing are held against, and over a list of neighbours, for large systems with a cutoff.
#pragma once
#include "charmm/topology.h"
#include "core/units.h"
#include "forces/pair_list.h"
#include "math/vec.h"

#include <optional>
#include <span>
#include <string_view>

namespace palpa {

// How energies end at a cutoff c, atom by atom, with m where switching begins. U is the energy
// without a cutoff, and S(r) = (c^2 - r^2)^2 (c^2 + 2 r^2 - 3 m^2) / (c^2 - m^2)^3 between m and c,
// 1 before. Sources: B. R. Brooks et al., J. Comput. Chem. 4, 187 (1983); P. J. Steinbach, B. R.
// Brooks, J. Comput. Chem. 15, 667 (1994). CHARMM's keywords are given in capitals.
enum class ElectrostaticCutoff {
    None,         // no end
    Switch,       // SWITCH: U S(r)
    Shift,        // SHIFT: U (1 - (r/c)^2)^2
    ForceShift,   // FSHIFT: U (1 - r/c)^2, whose force is that of U less its value at c. Of a
                  // constant dielectric only, as in CHARMM
    ForceSwitch,  // FSWITCH: the force of U times S(r); the energy is its integral
};
enum class VanDerWaalsCutoff {
    None,         // no end
    Switch,       // VSWITCH: U S(r)
    ForceSwitch,  // VFSWITCH: with U = A r^-12 - B r^-6, from m on
                  // A k12 (r^-6 - c^-6)^2 - B k6 (r^-3 - c^-3)^2, k12 = c^6/(c^6 - m^6),
                  // k6 = c^3/(c^3 - m^3); before m, U moved by a constant to meet it
};

struct NonbondedSettings {
    double coulomb_constant = units::charmm_coulomb_constant;  // C, kcal Å/mol/e^2
    double dielectric = 1;                                     // eps, CHARMM's EPS
    // A dielectric of eps r: E = C q q'/(eps r^2), CHARMM's RDIE.
    bool distance_dielectric = false;
    double coulomb14_factor = 1;  // of electrostatics between atoms three bonds apart, E14FAC

    ElectrostaticCutoff electrostatics = ElectrostaticCutoff::None;
    VanDerWaalsCutoff van_der_waals = VanDerWaalsCutoff::None;
    double switch_from = 10;  // m, Å, CTONNB
    double cutoff = 12;       // c, Å, CTOFNB
};

// What makes settings unusable, as a sentence for a message; none where they are sound.
std::optional<std::string_view> find_problem(const NonbondedSettings& settings) noexcept;

// Whether no pair acts from the cutoff on: what a list of neighbours needs.
bool has_end(const NonbondedSettings& settings) noexcept;

struct NonbondedEnergy {
    double van_der_waals = 0;  // kcal/mol
    double electrostatic = 0;  // kcal/mol
};

// All add forces (kcal/mol/Å) to `forces`, one entry per atom, and return the energy; the settings
// must be sound. Sums run over the pairs in rising order, first per first atom. Pairs closer than
// `pair_core_radius` (field/pair_field.h) are continued as a parabola from there, so that atoms at
// one place give a finite energy and no force.

// Every pair that the topology does not exclude; with a cutoff, every one is still looked at.
NonbondedEnergy add_nonbonded_forces(const Topology& topology, const NonbondedSettings& settings,
                                     std::span<const Vec3> positions,
                                     std::span<Vec3> forces) noexcept;

// The pairs of a list that is not outdated and whose cutoff is at least that of the settings, which
// must have an end: the same numbers of each pair as above, in the order of the list, four
// neighbours beside each other. Of all rows, or of some (of several threads, each with forces of
// its own).
NonbondedEnergy add_nonbonded_forces(const Topology& topology, const NonbondedSettings& settings,
                                     const PairList& list, std::span<const Vec3> positions,
                                     std::span<Vec3> forces) noexcept;
NonbondedEnergy add_nonbonded_forces(const Topology& topology, const NonbondedSettings& settings,
                                     const PairList& list, PairRows rows,
                                     std::span<const Vec3> positions,
                                     std::span<Vec3> forces) noexcept;

// The pairs three bonds apart, with Lennard-Jones numbers of their own, ended by the same cutoff.
NonbondedEnergy add_nonbonded14_forces(const Topology& topology, const NonbondedSettings& settings,
                                       std::span<const Vec3> positions,
                                       std::span<Vec3> forces) noexcept;

}  // namespace palpa
