// Plays random hands, devices, periods and speeds on a scene of one axis. None may generate energy,
// end in a limit cycle or pass through the wall.
#pragma once
#include "core/draws.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpa {

struct ScenarioOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file and the scenario
    std::size_t count = 10000, first = 0;
    std::uint64_t seed = 1;
};

// A random hand, device and period, as "key=value".
std::vector<std::string> draw_hand(Draws& draws);

struct ScenarioResult {
    std::vector<std::string> settings;  // of the scenario, for palpa run --set
    // By the force at the hand over the way in and out, beyond what the static law does on the way
    // that the molecule went; + = generated.
    double generated_J = 0;
    double ripple_N = 0;          // above 3 Hz, over the last 4 s
    double closest_angstrom = 0;  // closest distance on the line
    bool went_through = false;
    bool was_held_back = false;  // by a safety stage more severe than the thermal limit
    double clamped_share = 0;    // share of the time at the force limit

    bool is_calm() const noexcept;
};

// Limits for a scenario.
inline constexpr double most_generated_J = 1e-3, most_ripple_N = 0.02;

// Checks that the scene has one axis. Throws LoadError.
void check_scenarios(const ScenarioOptions& options);

// Plays scenario `number` of a seed, independent of all others. Throws LoadError.
ScenarioResult play_scenario(const ScenarioOptions& options, std::size_t number);

// Plays all scenarios; calls `on_result` after each.
std::vector<ScenarioResult> play_scenarios(
    const ScenarioOptions& options,
    const std::function<void(std::size_t number, const ScenarioResult&)>& on_result);

}  // namespace palpa
