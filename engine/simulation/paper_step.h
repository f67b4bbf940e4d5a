// The paper's step in a world: a few joints and bases are active at a time, chosen now and then
// from all of them (statics/adaptive_step.h). Used through simulation/solver.h.
#pragma once
#include "core/hands.h"
#include "ecs/world.h"
#include "simulation/plan_mechanics.h"
#include "simulation/resources.h"
#include "simulation/systems/step_input.h"
#include "statics/accuracy_controller.h"
#include "statics/adaptive_step.h"
#include "statics/relax_joints.h"
#include "statics/renewal.h"
#include "statics/time_budget.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

struct Ball {
    Vec3 centre;  // Å
    double radius;
};

// The difference between the force on each hand and that of complete relaxation, with all joints
// and pairs, to an rms force of 0.1 kcal/mol per rad and Å; estimated on a copy now and then, or,
// if an accuracy is set, as often as its share of the work allows.
struct ErrorEstimate {
    SecondOrderSettings settings;
    HeldParts held;
    std::optional<RenewalMemory> memory;  // set by the first estimate
    std::size_t steps = 0;                // step of the simulation
    // Errors found last, and forces at that time, by the number of the hand.
    std::array<std::optional<double>, most_hands> last_pN;
    std::array<Vec3, most_hands> felt_pN{};
    std::size_t evaluations = 0;  // number of evaluations used

    ErrorEstimate without_caches() const;
};

// The part of a PaperStep that cannot be rebuilt from the world.
struct PaperPlan {
    AdaptiveSettings settings;
    std::size_t steps = 0;         // relaxation steps in a step of the simulation
    std::size_t choose_every = 0;  // relaxation steps between selections, from the scene
    std::optional<TimeBudget> budget;
    // If the scene sets an accuracy: the controller of the work.
    std::optional<AccuracyController> accuracy;
    // Before a step: the force rendered to each hand at its present pose, kcal/mol/Å; nothing: use
    // the step's own result.
    std::array<std::optional<Vec3>, most_hands> rendered;
    // Weight of each joint by what it moves; empty: all equal. Then whether parts near hands have
    // more weight, and the regions found last.
    std::vector<double> mobility_weights;
    bool weighs_hand_proximity = false;
    std::vector<Ball> near_to;  // region around each hand
};

struct PaperStep : PaperPlan {
    AdaptiveStatics statics;
    std::size_t copied = 0;     // number of cluster rebuilds at the last full copy of positions
    bool lacks_caches = false;  // all of `statics` but its step length, guides and counters
    // Nothing with more coordinates than such a comparison can have.
    std::optional<ErrorEstimate> estimate;

    PaperStep without_caches() const;
    std::size_t count_bytes() const noexcept;
};

PaperStep build_paper_step(const QuasiStaticSettings& settings, const TorsionModel& model,
                           std::span<const HeldPart> held, const World& world);
// After the springs were gathered. Compares with all pairs, whatever cutoff the steps have; the
// ends that go with a solvent are part of its energy.
ErrorEstimate build_error_estimate(const QuasiStaticSettings& settings, const World& world);

// The functions that simulation/solver.h calls for every solver that relaxes.

void start(World& world, PaperStep& paper);
void restart(World& world, PaperStep& paper);
void restore(World& world, PaperStep& paper);
RelaxStepReport relax(World& world, PaperStep& paper, const StepInput& input);
Vec3 find_force(const World& world, const PaperStep& paper, Entity hand) noexcept;
Vec6 find_pull(const World& world, const PaperStep& paper, Entity hand) noexcept;

// Records the forces that the servos rendered at the hands' present poses, in the fields of the
// previous step, if an accuracy is set.
void before_step(World& world, PaperStep& paper, const StepInput& input);
// Estimates the error if it is due.
void after_step(World& world, PaperStep& paper);
// Makes such an estimate for all hands at once.
void find_error(World& world, PaperStep& paper);
// Adds the time of the step to the budget.
void note_time(const StepReport& report, PaperStep& paper);

// Updates the positions in the table that the mechanics have changed since the last call.
void copy_positions(World& world, PaperStep& paper);

}  // namespace palpa
