// Non-bonded energies (Lennard-Jones, Coulomb, solvation) of a topology's pairs in double: over all
// pairs, the reference implementation, and over a neighbour list for large systems with a cutoff.
#pragma once
#include "charmm/topology.h"
#include "core/units.h"
#include "field/cutoff.h"
#include "field/pair_field.h"
#include "forces/pair_list.h"
#include "math/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace palpa {

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

    // Except for None the topology must have solvation parameters.
    SolvationEnd solvation = SolvationEnd::None;
};

// EEF1-SB: a dielectric of 1.5 r, pairs three bonds apart in full, and smooth ends at 9 Å.
// (S. Bottaro, K. Lindorff-Larsen, R. B. Best, J. Chem. Theory Comput. 9, 5641 (2013).) Published
// with other ends of electrostatics, whole groups at a time, and of Lennard-Jones.
NonbondedSettings eef1_settings(SolvationEnd solvation = SolvationEnd::Smooth) noexcept;

// The same settings without solvation.
NonbondedSettings without_solvation(NonbondedSettings settings) noexcept;

// The law of settings for sums between sets of points: with eef1_settings() its smooth ends,
// without any end Coulomb's and Lennard-Jones's law. Nothing for others, which those sums do not
// have.
std::optional<PairRule> find_field_rule(const NonbondedSettings& settings,
                                        std::span<const ReplacedPair> replaced = {}) noexcept;

// What is wrong with the settings, as a sentence for a message; empty if they are valid.
std::optional<std::string_view> find_problem(const NonbondedSettings& settings) noexcept;

// Whether both electrostatics and Lennard-Jones have a cutoff, which a neighbour list requires.
bool has_end(const NonbondedSettings& settings) noexcept;

// Distance beyond which no pair interacts, Å: the cutoff, or that of solvation if it is larger.
// Infinite without a cutoff.
double find_reach(const NonbondedSettings& settings) noexcept;

struct NonbondedEnergy {
    double van_der_waals = 0;  // kcal/mol
    double electrostatic = 0;  // kcal/mol
    double solvation = 0;      // kcal/mol, pairs only, without the atoms' own part

    double sum() const noexcept { return van_der_waals + electrostatic + solvation; }
};

// All add forces (kcal/mol/Å) to `forces`, one entry per atom, and return the energy; the settings
// must be sound. Sums run over the pairs in rising order, first per first atom. Pairs closer than
// `pair_core_radius` (field/pair_field.h) are continued as a parabola from there, so that atoms at
// one place give a finite energy and no force.

// All pairs that are not excluded; with a cutoff too, every pair is visited.
NonbondedEnergy add_nonbonded_forces(const Topology& topology, const NonbondedSettings& settings,
                                     std::span<const Vec3> positions,
                                     std::span<Vec3> forces) noexcept;

// The pairs of a list that is not outdated and whose cutoff is at least the settings' reach, which
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

// Only these pairs, with non-1-4 parameters.
NonbondedEnergy add_pair_forces(const Topology& topology, const NonbondedSettings& settings,
                                std::span<const std::array<std::uint32_t, 2>> pairs,
                                std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

// The 1-4 pairs with their own Lennard-Jones parameters and the same cutoff, and with full
// solvation.
NonbondedEnergy add_nonbonded14_forces(const Topology& topology, const NonbondedSettings& settings,
                                       std::span<const Vec3> positions,
                                       std::span<Vec3> forces) noexcept;

// Only some of the 1-4 pairs.
NonbondedEnergy add_pair14_forces(const Topology& topology, const NonbondedSettings& settings,
                                  std::span<const std::array<std::uint32_t, 2>> pairs,
                                  std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

}  // namespace palpa
