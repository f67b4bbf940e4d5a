// Lennard-Jones, Coulomb and solvation of a topology's pairs in double: over all pairs, the
// reference that faster ways of summing are held against, and over a list of neighbours, for large
// systems with a cutoff.
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

    // Anything but None needs the topology's numbers.
    SolvationEnd solvation = SolvationEnd::None;
};

// EEF1-SB: a dielectric of 1.5 r, pairs three bonds apart in full, and smooth ends at 9 Å.
// (S. Bottaro, K. Lindorff-Larsen, R. B. Best, J. Chem. Theory Comput. 9, 5641 (2013).) Published
// with other ends of electrostatics, whole groups at a time, and of Lennard-Jones.
NonbondedSettings eef1_settings(SolvationEnd solvation = SolvationEnd::Smooth) noexcept;

// The same but for solvation, which they have none of then.
NonbondedSettings without_solvation(NonbondedSettings settings) noexcept;

// The law of settings for sums between sets of points: with eef1_settings() its smooth ends,
// without any end Coulomb's and Lennard-Jones's law. Nothing for others, which those sums do not
// have.
std::optional<PairRule> find_field_rule(const NonbondedSettings& settings,
                                        std::span<const ReplacedPair> replaced = {}) noexcept;

// What makes settings unusable, as a sentence for a message; none where they are sound.
std::optional<std::string_view> find_problem(const NonbondedSettings& settings) noexcept;

// Whether electrostatics and Lennard-Jones end at the cutoff: what a list of neighbours needs.
bool has_end(const NonbondedSettings& settings) noexcept;

// From where on no pair acts, Å: the cutoff, or where solvation ends if that is farther. Infinite
// without an end.
double find_reach(const NonbondedSettings& settings) noexcept;

struct NonbondedEnergy {
    double van_der_waals = 0;  // kcal/mol
    double electrostatic = 0;  // kcal/mol
    double solvation = 0;      // kcal/mol, of the pairs: without what atoms have alone

    double sum() const noexcept { return van_der_waals + electrostatic + solvation; }
};

// All add forces (kcal/mol/Å) to `forces`, one entry per atom, and return the energy; the settings
// must be sound. Sums run over the pairs in rising order, first per first atom. Pairs closer than
// `pair_core_radius` (field/pair_field.h) are continued as a parabola from there, so that atoms at
// one place give a finite energy and no force.

// Every pair that the topology does not exclude; with a cutoff, every one is still looked at.
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

// Only the pairs given, by the numbers of plain pairs.
NonbondedEnergy add_pair_forces(const Topology& topology, const NonbondedSettings& settings,
                                std::span<const std::array<std::uint32_t, 2>> pairs,
                                std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

// The pairs three bonds apart, with Lennard-Jones numbers of their own, ended by the same cutoff,
// and solvation in full.
NonbondedEnergy add_nonbonded14_forces(const Topology& topology, const NonbondedSettings& settings,
                                       std::span<const Vec3> positions,
                                       std::span<Vec3> forces) noexcept;

// Only some of those.
NonbondedEnergy add_pair14_forces(const Topology& topology, const NonbondedSettings& settings,
                                  std::span<const std::array<std::uint32_t, 2>> pairs,
                                  std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

}  // namespace palpa
