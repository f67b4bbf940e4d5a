// The quasi-static step with few active joints, which does work only where something moves.
// Every few steps the active joints and bases are selected from the whole assembly tree. Bodies
// connected by inactive joints form a rigid cluster; forces within a cluster are constant in its
// frame. A step sums the forces between clusters and traverses a tree of clusters.
#pragma once
#include "assembly/hybrid.h"
#include "assembly/selection.h"
#include "forces/group_forces.h"
#include "statics/step_quasi_static.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace palpa {

struct AdaptiveSettings {
    QuasiStaticSettings step;
    SelectionLimits limits;
    MetricWeight weight = MetricWeight::Plain;
    std::vector<double> factors;    // as in MetricWeights
    std::size_t choose_every = 10;  // steps between selections, above 0
    // Å, skin of the neighbour list between clusters, in addition to the motion of a step and of
    // the hand. The list is renewed when an atom has moved by about half of it. A small skin makes
    // steps cheaper and renewals more frequent.
    double tile_skin = 0.6;
    // Selections between two complete sums, which remove rounding errors of single precision.
    std::size_t renew_every = 32;  // above 0
};

// Difference between the state and a complete recomputation.
struct AdaptiveDeviation {
    double position = 0;  // largest deviation of an atom from its coordinates, Å
    double force = 0;     // on any atom, relative to the larger of its own and the rms force
    double energy = 0;    // kcal/mol
};

// State that steps carry over from one to the next.
struct AdaptiveStatics {
    ForceMemory memory;  // of the whole force field

    // For the selection: accelerations and their metric with everything active.
    AssemblyState whole;
    AccelerationMetric metric;
    JointSelection selection;
    std::size_t steps_since_choice = 0, choices = 0, renewals = 0, rebuilds = 0;

    // The clusters and the forces between them.
    HybridTree clusters;
    HybridState moving;
    GroupForces across;
    std::vector<std::uint32_t> cluster_of;  // of each atom
    // True if everything is active and fast pairs have a cutoff: then the whole force field acts
    // between clusters, with the memory's lists, in place of `across`, and nothing within them.
    bool is_whole = false;
    // Set by the caller for each molecule: whether a hand moves its base, so that it is never at
    // rest relative to others; see shift_base and turn_base.
    std::vector<std::uint8_t> is_guided;
    std::vector<std::uint32_t> pulled;  // atoms on which `across` acts
    std::vector<Vec3> across_forces;    // kcal/mol/Å; only for these atoms
    EnergyTerms across_terms;
    // Forces within clusters, in the frame of the cluster.
    std::vector<Vec3> within_forces;
    EnergyTerms within_terms;

    // Of the step that is tried.
    std::vector<double> turns;           // rotation of each cluster's joint, rad
    std::vector<Vec6> base_moves;        // of each molecule
    std::vector<std::uint8_t> is_moved;  // of each cluster
    // The same, accumulated since the caller wrote 0 or clusters were rebuilt (`rebuilds`); for
    // code that keeps copies.
    std::vector<std::uint8_t> has_moved;
    std::vector<Vec3> clustered;  // positions at the last build of clusters
    double tile_skin = 0;         // Å, skin of `across`
    // For each molecule: displacement of its farthest atom at the hand's last move, Å.
    std::vector<double> shifts;
    std::vector<Vec3> trial_forces;
    std::vector<Vec3> positions;  // before the step, of atoms in moving clusters
    HybridState start;            // before the step: frames, wrenches and guides

    double h = 0;               // AKMA time; 0 before the first step
    double renewed_energy = 0;  // kcal/mol, at the last complete sum
    // kcal/mol/Å, the largest rms force since then at which forces within clusters were rounded
    double rounded_force = 0;
    bool is_built = false;
};

AdaptiveStatics build_adaptive_statics(const TorsionModel& model);

struct [[nodiscard]] AdaptiveReport {
    QuasiStaticReport step;
    bool is_chosen = false;  // joints were selected in this step
};

// Move a base by hand, like those of torsion_state.h. Every hand may move its own base.
void shift_base(const TorsionModel& model, std::size_t molecule, const Vec3& by,
                TorsionState& state, AdaptiveStatics& statics) noexcept;
void turn_base(const TorsionModel& model, std::size_t molecule, const Eigen::Quaterniond& turn,
               const Vec3& by, TorsionState& state, AdaptiveStatics& statics) noexcept;

// Computes the energy, and the forces between clusters, of the present state. Call it first after
// the state or its springs were changed. Only the energy of the state is complete; for its `forces`
// see complete_forces. Selects joints if due. Returns false if energies are not finite or an atom
// is farther out than 1e6 Å; then only positions are valid.
[[nodiscard]] bool update_adaptive_forces(const TorsionModel& model,
                                          const AdaptiveSettings& settings, TorsionState& state,
                                          AdaptiveStatics& statics);

// step_quasi_static for the active joints and bases. With everything active it equals that function
// up to rounding at the same cost, and nothing is selected again until the limits are exceeded.
AdaptiveReport step_adaptive(const TorsionModel& model, const AdaptiveSettings& settings,
                             TorsionState& state, AdaptiveStatics& statics);

// Writes all forces of the state, which otherwise are those of the last selection.
void complete_forces(const TorsionModel& model, const AdaptiveStatics& statics,
                     TorsionState& state) noexcept;

// Force and torque about the origin from all other molecules and from springs, on a molecule that
// is guided or has an active base.
Vec6 find_wrench_on(const AdaptiveStatics& statics, std::size_t molecule) noexcept;

// Number of active joints and degrees of freedom of bases.
std::size_t find_active_freedom(const TorsionModel& model, const AdaptiveStatics& statics) noexcept;

// Recomputes everything, which is slow; changes nothing.
AdaptiveDeviation find_deviation(const TorsionModel& model, const AdaptiveSettings& settings,
                                 const TorsionState& state, const AdaptiveStatics& statics);

}  // namespace palpa
