#include "simulation/resources.h"

#include "ecs/world.h"
#include "simulation/held.h"

#include <utility>

namespace palpa {
namespace {

// Copies what a rebuilt state goes on with.
void keep_history(const AdaptiveStatics& from, AdaptiveStatics& to) {
    to.h = from.h;
    to.is_guided = from.is_guided;
    to.steps_since_choice = from.steps_since_choice;
    to.choices = from.choices;
    to.renewals = from.renewals;
    to.rebuilds = from.rebuilds;
    to.memory.evaluations = from.memory.evaluations;
}

}  // namespace

AdaptiveState AdaptiveState::without_caches() const {
    AdaptiveState kept;
    static_cast<AdaptivePlan&>(kept) = *this;
    keep_history(statics, kept.statics);
    kept.lacks_caches = true;
    return kept;
}

SecondOrder SecondOrder::without_caches() const {
    SecondOrder kept;
    static_cast<SecondOrderPlan&>(kept) = *this;
    kept.statics.renewals.lineariser.held = statics.renewals.lineariser.held;
    kept.lacks_caches = true;
    return kept;
}

ErrorEstimate ErrorEstimate::without_caches() const {
    return {settings, held, {}, steps, last_pN, felt_pN, evaluations};
}

// Pairs and their tiles, trial states and assembly of a solver: measured on HIV protease.
constexpr std::size_t bytes_of_solver_per_atom = 3000;

std::size_t Solver::count_bytes() const noexcept {
    return bytes_of_solver_per_atom * statics.trial.positions.size();
}

std::size_t AdaptiveState::count_bytes() const noexcept {
    return bytes_of_solver_per_atom * statics.across_forces.size();
}

std::size_t SecondOrder::count_bytes() const noexcept {
    // Matrices of all coordinates: of the derivatives, their factor, and the model.
    constexpr std::size_t doubles = 8;
    const auto size = static_cast<std::size_t>(statics.at.size());
    return doubles * sizeof(double) * size * size;
}

void restore_caches(World& world) noexcept {
    if (!has_mobile(world)) return;
    const TorsionModel& model = model_of(world);
    const AdaptiveState* const adaptive = world.find_resource<AdaptiveState>();
    if (adaptive && adaptive->lacks_caches) {
        AdaptiveState& restored = world.write<AdaptiveState>();
        AdaptiveStatics statics = build_adaptive_statics(model);
        keep_history(restored.statics, statics);
        restored.statics = std::move(statics);
        restored.lacks_caches = false;
        (void)update_adaptive_forces(model, restored.settings, world.write<TorsionState>(),
                                     restored.statics);
    }
    // The next step linearises.
    const SecondOrder* const second = world.find_resource<SecondOrder>();
    if (second && second->lacks_caches) {
        SecondOrder& restored = world.write<SecondOrder>();
        HeldParts held = restored.statics.renewals.lineariser.held;
        restored.statics = build_second_order_statics(model, std::move(held));
        restored.lacks_caches = false;
    }
}

}  // namespace palpa
