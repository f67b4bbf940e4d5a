// The quasi-static step with few active joints: work only where something moves.
//
// Every few steps joints and bases are chosen from the whole assembly tree. What is joined by
// joints at rest is then one rigid cluster; what its atoms do to each other is kept in its frame. A
// step sums what reaches from cluster to cluster, and passes over a tree of clusters.
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
    std::size_t choose_every = 10;  // steps, above 0
    // Å, beside what a step and the hand need; of fast pairs between clusters, found again when an
    // atom has moved by about half of it. Less is less work for each step and more often work in
    // between.
    double tile_skin = 0.6;
    // Choices between two sums over everything, which take away what single precision has rounded.
    std::size_t renew_every = 32;  // above 0
};

// How far the state is from what everything, computed anew, says.
struct AdaptiveDeviation {
    double position = 0;  // of any atom, Å, against its coordinates
    double force = 0;     // on any atom, of the larger of its own and the rms force
    double energy = 0;    // kcal/mol
};

// What steps remember from one to the next.
struct AdaptiveStatics {
    ForceMemory memory;  // of the whole

    // The choice: accelerations and their metric with everything active.
    AssemblyState whole;
    AccelerationMetric metric;
    JointSelection selection;
    std::size_t steps_since_choice = 0, choices = 0, renewals = 0, rebuilds = 0;

    // The clusters, and what acts between them.
    HybridTree clusters;
    HybridState moving;
    GroupForces across;
    std::vector<std::uint32_t> cluster_of;  // of each atom
    // Where everything is active, but for fast pairs that end nowhere: not `across` but the whole
    // force field acts between clusters, by the memory's lists, and nothing within them.
    bool is_whole = false;
    // The caller's, of each molecule: whether its base is moved by hand, so that it is never at
    // rest against others. shift_base and turn_base see to it.
    std::vector<std::uint8_t> is_guided;
    std::vector<std::uint32_t> pulled;  // atoms on which that acts
    std::vector<Vec3> across_forces;    // kcal/mol/Å; only of these
    EnergyTerms across_terms;
    // What acts within them: forces with the axes of the cluster's frame.
    std::vector<Vec3> within_forces;
    EnergyTerms within_terms;

    // Of the step that is tried.
    std::vector<double> turns;           // of each cluster's joint, rad
    std::vector<Vec6> base_moves;        // of each molecule
    std::vector<std::uint8_t> is_moved;  // of each cluster
    // The same since the caller wrote 0 or clusters were built (`rebuilds`); for those who keep
    // copies.
    std::vector<std::uint8_t> has_moved;
    std::vector<Vec3> clustered;  // positions when clusters were built
    double tile_skin = 0;         // Å, that `across` was built with
    // Of each molecule: how far its farthest atom went when the hand moved it last, Å.
    std::vector<double> shifts;
    std::vector<Vec3> trial_forces;
    std::vector<Vec3> positions;  // before it, of atoms in clusters that move
    HybridState start;            // before it: frames, wrenches and guides

    double h = 0;               // AKMA time; 0 before the first step
    double renewed_energy = 0;  // kcal/mol, at the last sum over everything
    // kcal/mol/Å, the largest rms force since then at which forces within clusters were rounded.
    double rounded_force = 0;
    bool is_built = false;
};

AdaptiveStatics build_adaptive_statics(const TorsionModel& model);

struct [[nodiscard]] AdaptiveReport {
    QuasiStaticReport step;
    bool is_chosen = false;  // joints were chosen in this step
};

// Move a base by hand, as those of torsion_state.h do. Each hand may move its own.
void shift_base(const TorsionModel& model, std::size_t molecule, const Vec3& by,
                TorsionState& state, AdaptiveStatics& statics) noexcept;
void turn_base(const TorsionModel& model, std::size_t molecule, const Eigen::Quaterniond& turn,
               const Vec3& by, TorsionState& state, AdaptiveStatics& statics) noexcept;

// Energy, and forces between clusters, where the state is now; before anything else after the state
// or its springs were changed by hand. The energy is that of the state, `forces` of the state are
// not: see complete_forces. Joints are chosen if that is due. False where energies are not finite
// or atoms farther out than 1e6 Å: then only positions are of use, until they are mended.
[[nodiscard]] bool update_adaptive_forces(const TorsionModel& model,
                                          const AdaptiveSettings& settings, TorsionState& state,
                                          AdaptiveStatics& statics);

// step_quasi_static for the joints and bases that are active. With everything active it is that, to
// rounding, and costs no more: where the limits have room for all there is nothing to choose again,
// until they have not.
AdaptiveReport step_adaptive(const TorsionModel& model, const AdaptiveSettings& settings,
                             TorsionState& state, AdaptiveStatics& statics);

// Writes all forces of the state, which are otherwise those of the last choice.
void complete_forces(const TorsionModel& model, const AdaptiveStatics& statics,
                     TorsionState& state) noexcept;

// Force and torque about the origin that all others, and springs, put on a molecule that is
// guided or whose base is active.
Vec6 find_wrench_on(const AdaptiveStatics& statics, std::size_t molecule) noexcept;

// Joints, and degrees of freedom of bases, that are active.
std::size_t find_active_freedom(const TorsionModel& model, const AdaptiveStatics& statics) noexcept;

// Recomputes everything, which is slow; changes nothing.
AdaptiveDeviation find_deviation(const TorsionModel& model, const AdaptiveSettings& settings,
                                 const TorsionState& state, const AdaptiveStatics& statics);

}  // namespace palpa
