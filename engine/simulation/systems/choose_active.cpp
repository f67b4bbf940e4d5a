#include "simulation/systems/choose_active.h"

#include "simulation/held.h"
#include "simulation/resources.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace palpa {
namespace {

// The centre of mass of a molecule of the model.
Vec3 find_centre(const World& world, std::size_t molecule) {
    const TorsionModel& model = model_of(world);
    const std::vector<Vec3>& positions = world.resource<TorsionState>().positions;
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (model.tree.molecule_of[model.tree.bodies.body_of[i]] == molecule)
            sum += model.masses[i] * positions[i];
    }
    return sum / model.molecule_masses[molecule];
}

// What a hand holds: the atoms at its spring, or a molecule as large as it was at the last choice.
Ball find_ball(const World& world, Entity hand, const AdaptiveState& adaptive) {
    if (const ModelSpring* const spring = spring_of(world, hand)) {
        const std::vector<Vec3>& positions = world.resource<TorsionState>().positions;
        return {find_centre_of_mass(model_of(world), spring->atoms, positions), 0};
    }
    const auto base = static_cast<std::size_t>(grip_of(world, hand).base);
    return {find_centre(world, base), adaptive.statics.whole.gyration[base]};
}

// Balls around what hands hold; none before accelerations were computed.
std::vector<Ball> find_balls(const World& world, const AdaptiveState& adaptive) {
    std::vector<Ball> balls;
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        if (grip.base < 0 || (!adaptive.statics.is_built && holds_whole(world, hand))) return;
        balls.push_back(find_ball(world, hand, adaptive));
    });
    return balls;
}

bool is_about(const std::vector<Ball>& balls, const std::vector<Ball>& before) {
    constexpr double about = 0.5;  // Å
    return balls.size() == before.size() &&
           std::equal(balls.begin(), balls.end(), before.begin(), [](const Ball& a, const Ball& b) {
               return (a.centre - b.centre).norm() < about;
           });
}

double nearness_of(const Vec3& place, const std::vector<Ball>& balls) {
    constexpr double reach2 = 25;  // Å^2
    double most = 0;
    for (const auto& [centre, radius] : balls) {
        const double beyond = std::max(0.0, (place - centre).norm() - radius);
        const double nearness = reach2 / (reach2 + beyond * beyond);
        most = std::max(most, nearness * nearness);
    }
    return most;
}

// How much each joint counts: less than half from 5 Å on around what is held, then less and less.
// As long as that stays where it is about, all stays; with the same factors a choice costs less.
void update_factors(const World& world, AdaptiveState& adaptive) {
    const TorsionModel& model = model_of(world);
    const std::vector<Vec3>& positions = world.resource<TorsionState>().positions;
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<double>& factors = adaptive.settings.factors;
    std::vector<Ball> balls = find_balls(world, adaptive);
    if (!balls.empty() && is_about(balls, adaptive.near_to)) return;
    adaptive.near_to = std::move(balls);
    factors = adaptive.mobility_weights;
    if (adaptive.near_to.empty()) return;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (model.tree.bodies.is_base(b)) continue;
        factors[b] *= nearness_of(positions[bodies[b].axis[1]], adaptive.near_to);
    }
}

}  // namespace

void choose_active(World& world, const StepInput& /*input*/) {
    const AdaptiveState* const adaptive = world.find_resource<AdaptiveState>();
    if (!adaptive) return;
    const std::size_t steps = adaptive->accuracy ? adaptive->accuracy->work_budget().steps
                                                 : world.resource<Solver>().settings.steps;
    if (adaptive->statics.steps_since_choice + steps > adaptive->settings.choose_every)
        prepare_choice(world);
}

void prepare_choice(World& world) {
    AdaptiveState& adaptive = world.write<AdaptiveState>();
    const std::size_t together = world.resource<Solver>().settings.steps;
    if (adaptive.weighs_hand_proximity) update_factors(world, adaptive);
    auto most = static_cast<std::size_t>(model_of(world).coordinates);
    if (adaptive.accuracy) {
        const WorkBudget& work_budget = adaptive.accuracy->work_budget();
        most = adaptive.settings.limits.degrees_of_freedom = work_budget.active;
        // More steps are of the same moment, in which no others have to be chosen.
        adaptive.settings.choose_every = adaptive.choose_every * work_budget.steps / together;
    }
    if (!adaptive.budget) return;
    adaptive.settings.limits.degrees_of_freedom = adaptive.budget->find_freedom(most);
    // The budget is for as many quasi-static steps as make one of the simulation.
    const std::size_t usual = adaptive.choose_every;
    adaptive.settings.choose_every =
        std::max(usual, together * adaptive.budget->find_interval(usual / together));
}

}  // namespace palpa
