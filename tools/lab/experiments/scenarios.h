// Random hands, devices, periods and speeds on a scene of one axis. None may
// generate energy, end in a limit cycle, go through, or send more than clamp and slew allow.
// Disturbed ones have random gains, faults of the device and edits too.
#pragma once
#include "core/draws.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct ScenarioOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file and the scenario
    std::size_t count = 10000, first = 0;
    std::uint64_t seed = 1;
    bool is_disturbed = false;  // of scenes/water alone: experiments/disturbances.h
};

// A random hand, device and period, as "key=value".
std::vector<std::string> draw_hand(Draws& draws);

struct ScenarioResult {
    std::vector<std::string> settings;  // of the scenario, for palpa run --set
    // By the force at the hand over the way in and out, beyond what the static law does on the way
    // that the molecule went; + = generated. Of a disturbed one the most of any stretch in which
    // nothing was disturbed and the safety chain let the whole force through.
    double generated_J = 0;
    // All that the true motion of the handle and the force that was written did, faults included.
    double net_work_J = 0;
    // The same beyond the static law from where the molecule began to where it ended: what faults
    // gave. Nothing where edits changed the law on the way.
    std::optional<double> over_all_J;
    double judged_share = 0;                         // of the time, that stretches had
    double most_newton = 0, most_change_newton = 0;  // written; in a tick, but for drops to zero
    double clamp_newton = 0;                         // of the scene
    std::size_t faults = 0, edits = 0;
    double ripple_N = 0;          // above 3 Hz, over the last 4 s
    double closest_angstrom = 0;  // closest distance on the line
    bool went_through = false;
    bool was_held_back = false;  // by a safety stage more severe than the thermal limit
    double clamped_share = 0;    // share of the time at the force limit

    bool is_calm() const noexcept;
};

// Limits for a scenario.
inline constexpr double most_generated_J = 1e-3, most_ripple_N = 0.02;
// Of the force written, N in a tick: 500 N/s.
inline constexpr double most_slew_newton = 0.5;

// Checks that the scene has one axis. Throws LoadError.
void check_scenarios(const ScenarioOptions& options);

// Plays scenario `number` of a seed, independent of all others. Throws LoadError.
ScenarioResult play_scenario(const ScenarioOptions& options, std::size_t number);

// Plays all scenarios; calls `on_result` after each.
std::vector<ScenarioResult> play_scenarios(
    const ScenarioOptions& options,
    const std::function<void(std::size_t number, const ScenarioResult&)>& on_result);

}  // namespace palpa
