#include "tools/scenarios.h"

#include "core/draws.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "tools/hands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

namespace palpa {
namespace {

std::vector<std::string> draw_settings(Draws& draws) {
    constexpr double rest_s = 8, lead_s = 0.3;
    std::vector<std::string> settings = draw_hand(draws);
    const auto set = [&](const char* key, const auto& value) {
        settings.push_back(fmt::format("{}={}", key, value));
    };
    set("hand.start_angstrom", draws.between(2.7, 10));
    const double depth_mm = draws.between(20, 145), fastest_mm_per_s = draws.scale(30, 600);
    // Minimum jerk is fastest in the middle, at 15/8 of the mean.
    const double way_s = 15.0 / 8 * depth_mm / fastest_mm_per_s, pause_s = draws.between(0, 1);
    const double far = depth_mm / 2;
    const double in_s = lead_s + way_s, out_s = in_s + pause_s + 1e-3, end_s = out_s + way_s;
    settings.push_back(
        fmt::format("hand.path=[[{:.6f}, {:.4f}], [{:.6f}, {:.4f}], [{:.6f}, {:.4f}], "
                    "[{:.6f}, {:.4f}]]",
                    lead_s, far, in_s, -far, out_s, -far, end_s, far));
    set("run.seconds", fmt::format("{:.3f}", end_s + rest_s));
    return settings;
}

// Work (J) that the static law does on the hand while the molecule goes from one distance (Å) to
// another: the integral of f(F) A_d.
double static_work(const SceneDescription& scene, const Simulation& simulation, double from,
                   double to) {
    const ServoSettings servo = build_servo_settings(scene, simulation);
    const auto steps = static_cast<int>(std::ceil(std::abs(to - from) / 1e-3)) + 1;
    const double width = (to - from) / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const LineForce line = force_along_line_at(simulation, from + (i + 0.5) * width);
        const double F_m = line.force * units::newton_per_kcal_per_mol_angstrom;
        const double A_d = gain_where(servo, simulation, line);
        sum += hand_force(simulation.laws.force, F_m) * A_d;
    }
    return sum * width * units::metre_per_angstrom;
}

void check_scene(const ScenarioOptions& options) {
    const SceneDescription scene = read_scene(options.scene, options.settings);
    for (const MoleculeDescription& molecule : scene.molecules) {
        if (molecule.name != scene.grab.molecule || molecule.motion == Motion::AlongX) continue;
        throw LoadError(scene.place_of("grab.molecule"),
                        "moves in space, where work around a closed way is not nothing; expected a "
                        "molecule that moves along-x, or palpa loops");
    }
}

nlohmann::ordered_json as_json(std::size_t number, const ScenarioResult& result) {
    return {{"number", number},
            {"generated_J", result.generated_J},
            {"ripple_N", result.ripple_N},
            {"closest_angstrom", result.closest_angstrom},
            {"went_through", result.went_through},
            {"was_held_back", result.was_held_back},
            {"clamped_share", result.clamped_share},
            {"settings", result.settings}};
}

}  // namespace

std::vector<std::string> draw_hand(Draws& draws) {
    std::vector<std::string> settings{"hand.stroke=path"};
    const auto set = [&](const char* key, const auto& value) {
        settings.push_back(fmt::format("{}={}", key, value));
    };
    set("hand.grip", hand_names[1 + draws.below(hand_names.size() - 1)]);
    set("device.friction_N", draws.below(3) == 0 ? 0.0 : draws.between(0, 0.5));
    set("device.inertia_kg", draws.scale(0.03, 0.15));
    set("device.viscosity_N_s_per_m", draws.between(0.05, 0.5));
    set("device.servo_delay_ticks", draws.below(2));
    set("run.period_ms", std::lround(draws.scale(1, 100)));
    return settings;
}

bool ScenarioResult::is_calm() const noexcept {
    return generated_J <= most_generated_J && ripple_N < most_ripple_N && !went_through &&
           !was_held_back;
}

ScenarioResult play_scenario(const ScenarioOptions& options, std::size_t number) {
    Draws draws(options.seed, number);
    ScenarioResult result;
    result.settings = draw_settings(draws);
    result.settings.insert(result.settings.end(), options.settings.begin(), options.settings.end());
    const SceneDescription scene = read_scene(options.scene, result.settings);
    Simulation simulation = load_simulation(scene);
    EmulatedOmni device(build_emulated_omni(scene, simulation));
    const double start = grabbed_distance(simulation);
    const Summary summary = run_headless(scene, simulation, device, {}, nullptr, {});
    const double end = grabbed_distance(simulation);
    result.generated_J = summary.net_work_J - static_work(scene, simulation, start, end);
    result.ripple_N = summary.ripple ? summary.ripple->rms : 0;
    result.closest_angstrom = summary.closest_angstrom;
    result.went_through = summary.went_through;
    result.was_held_back = summary.gravest > SafetyStage::Hot;
    result.clamped_share = summary.clamped_share;
    return result;
}

std::vector<ScenarioResult> play_scenarios(
    const ScenarioOptions& options,
    const std::function<void(std::size_t number, const ScenarioResult&)>& on_result) {
    std::vector<ScenarioResult> results;
    for (std::size_t i = options.first; i < options.first + options.count; ++i) {
        results.push_back(play_scenario(options, i));
        if (on_result) on_result(i, results.back());
    }
    return results;
}

int scenarios_command(const ScenarioOptions& options) {
    check_scene(options);
    const bool is_watched = isatty(STDERR_FILENO) != 0;
    const std::size_t last = options.first + options.count;
    const std::vector<ScenarioResult> results =
        play_scenarios(options, [&](std::size_t number, const ScenarioResult& result) {
            if (is_watched && number % 50 == 0) fmt::print(stderr, "\r{} of {} ", number, last);
            if (result.is_calm() || options.json) return;
            fmt::print(
                "scenario {}: {:+.5f} J generated, ripple {:.3f} N, {:.3f} Å at the "
                "closest{}{}\n  palpa run --headless {} --set \"{}\"\n",
                number, result.generated_J, result.ripple_N, result.closest_angstrom,
                result.went_through ? ", went through" : "",
                result.was_held_back ? ", held back by the safety chain" : "",
                options.scene.string(), fmt::join(result.settings, "\" --set \""));
        });
    if (is_watched) fmt::print(stderr, "\r{:30}\r", "");
    const auto failed = static_cast<std::size_t>(
        std::ranges::count_if(results, [](const ScenarioResult& r) { return !r.is_calm(); }));
    double generated = -1, ripple = 0, closest = 1e9;
    std::size_t clamped = 0;
    for (const ScenarioResult& result : results) {
        generated = std::max(generated, result.generated_J);
        ripple = std::max(ripple, result.ripple_N);
        closest = std::min(closest, result.closest_angstrom);
        if (result.clamped_share > 0) ++clamped;
    }
    if (options.json) {
        nlohmann::ordered_json report{{"count", results.size()}, {"seed", options.seed},
                                      {"failed", failed},        {"most_generated_J", generated},
                                      {"most_ripple_N", ripple}, {"closest_angstrom", closest},
                                      {"clamped", clamped}};
        for (std::size_t i = 0; i < results.size(); ++i)
            report["scenarios"].push_back(as_json(options.first + i, results[i]));
        fmt::print("{}\n", report.dump(2));
    } else {
        fmt::print(
            "{} scenarios, {} missed a bar\n  generated   {:+.5f} J at most (bar {})\n"
            "  ripple      {:.4f} N at most (bar {})\n  molecule    {:.3f} Å at the closest\n"
            "  clamped     in {}\n",
            results.size(), failed, generated, most_generated_J, ripple, most_ripple_N, closest,
            clamped);
    }
    return failed == 0 ? 0 : 1;
}

}  // namespace palpa
