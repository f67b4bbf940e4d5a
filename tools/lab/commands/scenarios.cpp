// palpa-lab scenarios: random hands and devices on a scene of one axis; those that miss a limit,
// and the worst.
#include "tools/lab/experiments/scenarios.h"

#include "tools/commands/progress.h"
#include "tools/lab/commands/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

namespace palpa {
namespace {

struct ScenarioCommand {
    ScenarioOptions scenarios;
    bool json = false;
};

nlohmann::ordered_json as_json(std::size_t number, const ScenarioResult& result) {
    return {{"number", number},
            {"generated_J", result.generated_J},
            {"net_work_J", result.net_work_J},
            {"over_all_J", result.over_all_J ? nlohmann::ordered_json(*result.over_all_J)
                                             : nlohmann::ordered_json()},
            {"judged_share", result.judged_share},
            {"most_N", result.most_newton},
            {"most_change_N", result.most_change_newton},
            {"faults", result.faults},
            {"edits", result.edits},
            {"ripple_N", result.ripple_N},
            {"closest_angstrom", result.closest_angstrom},
            {"went_through", result.went_through},
            {"was_held_back", result.was_held_back},
            {"clamped_share", result.clamped_share},
            {"settings", result.settings}};
}

// The exit code: 1 where a limit is missed.
int run_scenarios(const ScenarioCommand& command) {
    const ScenarioOptions& options = command.scenarios;
    check_scenarios(options);
    CountLine count;
    const std::size_t last = options.first + options.count;
    const std::vector<ScenarioResult> results =
        play_scenarios(options, [&](std::size_t number, const ScenarioResult& result) {
            if (number % 50 == 0) count.show(fmt::format("{} of {}", number, last));
            if (result.is_calm() || command.json) return;
            fmt::print(
                "scenario {}: {:+.5f} J generated, ripple {:.3f} N, closest distance {:.3f} "
                "Å{}{}\n  palpa run --headless {} --set \"{}\"\n",
                number, result.generated_J, result.ripple_N, result.closest_angstrom,
                result.went_through ? ", went through" : "",
                result.was_held_back ? ", limited by the safety chain" : "", options.scene.string(),
                fmt::join(result.settings, "\" --set \""));
        });
    count.wipe();
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
    if (command.json) {
        nlohmann::ordered_json report{{"count", results.size()}, {"seed", options.seed},
                                      {"failed", failed},        {"most_generated_J", generated},
                                      {"most_ripple_N", ripple}, {"closest_angstrom", closest},
                                      {"clamped", clamped}};
        for (std::size_t i = 0; i < results.size(); ++i)
            report["scenarios"].push_back(as_json(options.first + i, results[i]));
        fmt::print("{}\n", report.dump(2));
    } else {
        fmt::print(
            "{} scenarios, {} missed a limit\n  generated   at most {:+.5f} J (limit {} J)\n  "
            "ripple      at most {:.4f} N (limit {} N)\n  molecule    closest distance {:.3f} Å\n  "
            "clipping    in {} scenarios\n",
            results.size(), failed, generated, most_generated_J, ripple, most_ripple_N, closest,
            clamped);
    }
    return failed == 0 ? 0 : 1;
}

}  // namespace

void add_scenarios(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& scenarios = *program.add_subcommand(
        "scenarios",
        "Test stability: does the force vibrate with random hands and devices on one axis?");
    ScenarioCommand& command = own_options<ScenarioCommand>(scenarios, chosen, run_scenarios);
    ScenarioOptions& options = command.scenarios;
    describe(scenarios, {"palpa-lab scenarios scenes/water --count 100"});
    scenarios.add_option("scene", options.scene, "scene folder or file")->required();
    scenarios.add_option("--count", options.count, "number of scenarios (default 10000)")
        ->check(in_range(1, 1e7));
    scenarios.add_option("--first", options.first, "number of the first scenario (default 0)")
        ->check(in_range(0, 1e12));
    add_seed_option(scenarios, options.seed);
    scenarios.add_flag("--json", command.json, "print every scenario as JSON");
    scenarios.add_flag("--disturbed", options.is_disturbed,
                       "also draw gains, laws and stop, faults of the device, and edits (for "
                       "scenes/water)");
    add_set_option(scenarios, options.settings);
}

}  // namespace palpa
