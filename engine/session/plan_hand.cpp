#include "session/plan_hand.h"

#include "core/load_error.h"
#include "core/units.h"
#include "simulation/components.h"
#include "simulation/probe.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>

namespace palpa {
namespace {

constexpr double first_rest_s = 0.3;  // before the hand sets out, and between cycles
constexpr double centring_margin_m = 0.005;

double newton_at(const Simulation& simulation, double distance) {
    return force_along_line_at(simulation, distance).force *
           units::newton_per_kcal_per_mol_angstrom;
}

// Handle travel (m) that takes the molecule from `far` in to `near` (Å): midpoint sum of A_d.
double handle_travel(const Simulation& simulation, double near, double far) {
    const auto steps = static_cast<int>(std::ceil((far - near) / 1e-3));
    const double width = (far - near) / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        sum += displacement_gain(simulation.laws.displacement,
                                 newton_at(simulation, near + (i + 0.5) * width));
    }
    return sum * width * units::metre_per_angstrom;
}

HandScript plan_in_out(const SceneDescription& scene, const Simulation& simulation,
                       double half_width_m) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    const double start = simulation.world.find<LineGuide>(grab.molecule)->distance;
    const double peak_newton = scene.hand.peak_nN * 1e-9;
    const std::optional<double> innermost =
        find_repulsion(simulation, peak_newton / units::newton_per_kcal_per_mol_angstrom, start);
    if (!innermost) {
        throw LoadError({scene.file.string()},
                        fmt::format("the repulsion reaches {} nN nowhere inside of {} Å; expected "
                                    "another hand.peak_nN or hand.start_angstrom",
                                    scene.hand.peak_nN, start));
    }
    const std::optional<HandModel> hand = hand_model(static_cast<Grip>(scene.hand.grip));
    const double peak_felt = hand_force(simulation.laws.force, peak_newton);
    const double bend = hand ? peak_felt / static_stiffness(*hand) : 0;
    const double travel = handle_travel(simulation, *innermost, start) + bend;
    const double outside = std::min(travel / 2, half_width_m - centring_margin_m);

    HandScript script;
    double time = first_rest_s;
    script.path.push_back({time, outside});
    for (std::int64_t cycle = 0; cycle < scene.hand.cycles; ++cycle) {
        script.path.push_back({time += scene.hand.stroke_s, outside - travel});
        script.path.push_back({time += std::max(scene.hand.pause_s, 1e-3), outside - travel});
        script.path.push_back({time += scene.hand.stroke_s, outside});
        script.path.push_back({time += first_rest_s, outside});
    }
    return script;
}

}  // namespace

HandScript plan_hand(const SceneDescription& scene, const Simulation& simulation,
                     double half_width_m) {
    HandScript script;
    switch (scene.hand.stroke) {
        case Stroke::Hold:
            script.path = {{0, 0}};
            break;
        case Stroke::InOut:
            script = plan_in_out(scene, simulation, half_width_m);
            break;
        case Stroke::Path:
            for (const auto& [time_s, x_mm] : scene.hand.path) {
                script.path.push_back({time_s, x_mm * 1e-3});
            }
            break;
    }
    script.kick_N_s = scene.hand.kick_N_s;
    return script;
}

}  // namespace palpa
