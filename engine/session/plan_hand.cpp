#include "session/plan_hand.h"

#include "core/load_error.h"
#include "core/units.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <variant>

namespace palpa {
namespace {

constexpr double first_rest_s = 0.3;  // before the hand sets out, and between cycles
constexpr double fastest_hand_m_per_s = 3;

// Handle travel (m) that takes the molecule from `far` in to `near` (Å): midpoint sum of A_d.
double handle_travel(const SceneDescription& scene, const World& world, std::size_t slot,
                     double near, double far) {
    const ServoSettings servo = build_servo_settings(scene, world, slot);
    const Entity hand = hand_at(world, slot);
    const CouplingLaws& laws = coupling_of(world, hand).laws;
    // Where A_d does not vary one step is enough, and a look at a large molecule takes
    // milliseconds.
    const bool constant =
        !servo.guarded && std::holds_alternative<ConstantDisplacementLaw>(laws.displacement);
    const double fineness = moves_in_space(world, hand) ? 0.02 : 1e-3;  // Å
    const auto integral = [&](double from, double to, double step) {
        const auto steps = constant ? 1 : static_cast<int>(std::ceil((to - from) / step));
        const double width = (to - from) / steps;
        double sum = 0;
        for (int i = 0; i < steps; ++i)
            sum +=
                gain_where(servo, laws, force_along_line_at(world, from + (i + 0.5) * width, hand));
        return sum * width * units::metre_per_angstrom;
    };
    // Far out the gain hardly changes.
    constexpr double calm = 100;
    if (far - near <= calm) return integral(near, far, fineness);
    return integral(near, near + calm, fineness) + integral(near + calm, far, 1);
}

HandScript plan_in_out(const SceneDescription& scene, std::size_t slot, const World& world,
                       double half_width_m) {
    const HandTables tables = list_hands(scene).at(slot);
    const Entity entity = hand_at(world, slot);
    const std::string& key = tables.hand_key;
    if (!tables.grab.atom.empty()) {
        throw LoadError(
            scene.place_of(key + ".stroke"),
            fmt::format("'{}.stroke' is \"in-out\", but the hand pulls by a spring ({}.atom), "
                        "which has no repulsion peak; expected \"path\" or \"hold\"",
                        key, tables.grab_key));
    }
    const double start = grabbed_distance(world, entity);
    const double peak_newton = tables.hand.peak_nN * 1e-9;
    const std::optional<double> innermost = repulsion_distance(
        world, peak_newton / units::newton_per_kcal_per_mol_angstrom, start, entity);
    if (!innermost) {
        throw LoadError(scene.place_of(key + ".peak_nN"),
                        fmt::format("the repulsion does not reach {} nN within {} Å; expected "
                                    "another {}.peak_nN or {}.start_angstrom",
                                    tables.hand.peak_nN, start, key, key));
    }
    const std::optional<HandModel> hand = hand_model(tables.hand.grip);
    const double peak_felt = hand_force(coupling_of(world, entity).laws.force, peak_newton);
    const double bend = hand ? peak_felt / static_stiffness(*hand) : 0;
    const double travel = handle_travel(scene, world, slot, *innermost, start) + bend;
    const double outside = std::min(travel / 2, half_width_m - stop_margin_m);

    HandScript script;
    double time = first_rest_s;
    script.path.push_back({time, outside});
    for (std::int64_t cycle = 0; cycle < tables.hand.cycles; ++cycle) {
        script.path.push_back({time += tables.hand.stroke_s, outside - travel});
        script.path.push_back({time += std::max(tables.hand.pause_s, 1e-3), outside - travel});
        script.path.push_back({time += tables.hand.stroke_s, outside});
        script.path.push_back({time += first_rest_s, outside});
    }
    return script;
}

// A path that no hand could follow would end somewhere else than it says.
void check_speed(const SceneDescription& scene, const HandTables& tables,
                 const HandScript& script) {
    for (std::size_t i = 1; i < script.path.size(); ++i) {
        const HandWaypoint &from = script.path[i - 1], &to = script.path[i];
        // Minimum jerk is fastest in the middle, at 15/8 of the mean.
        const Vec3 way(to.x_m - from.x_m, to.y_m - from.y_m, to.z_m - from.z_m);
        const double speed = 15.0 / 8 * way.norm() / (to.time_s - from.time_s);
        if (speed <= fastest_hand_m_per_s) continue;
        const bool own_path = tables.hand.stroke == Stroke::Path;
        throw LoadError(scene.place_of(tables.hand_key + (own_path ? ".path" : ".stroke_s")),
                        fmt::format("the stroke needs a hand speed of {:.3g} m/s; expected at most "
                                    "{} m/s, so give the stroke more time",
                                    speed, fastest_hand_m_per_s));
    }
}

}  // namespace

std::vector<HandWaypoint> plan_lead(const std::vector<PathPoint>& path) {
    std::vector<HandWaypoint> way;
    for (const auto& [time_s, place, turn] : path) {
        const Vec3 place_m = units::metre_per_angstrom * Vec3(place.data());
        way.push_back({time_s, place_m.x(), place_m.y(), place_m.z()});
    }
    return way;
}

HandScript plan_hand(const SceneDescription& scene, const World& world, double half_width_m,
                     std::size_t slot) {
    const HandTables tables = list_hands(scene).at(slot);
    const HandDescription& hand = tables.hand;
    HandScript script;
    switch (hand.stroke) {
        case Stroke::Hold:
            script.path = {{0, 0}};
            break;
        case Stroke::InOut:
            script = plan_in_out(scene, slot, world, half_width_m);
            break;
        case Stroke::Path:
            for (const auto& [time_s, place, turn] : hand.path) {
                script.path.push_back({time_s, place[0] * 1e-3, place[1] * 1e-3, place[2] * 1e-3,
                                       Vec3(turn.data()) * (std::numbers::pi / 180)});
            }
            break;
        case Stroke::Lead:
            script.leads = true;
            script.path = plan_lead(hand.path);
            break;
    }
    script.kick_N_s = hand.kick_N_s;
    script.release_s = hand.release_s;
    check_speed(scene, tables, script);
    return script;
}

}  // namespace palpa
