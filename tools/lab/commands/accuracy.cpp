// palpa-lab accuracy: plays a scene's stroke for each force range and tolerance; a row for each.
#include "tools/lab/experiments/accuracy.h"
#include "core/load_error.h"
#include "core/text.h"
#include "session/accuracy_report.h"
#include "tools/commands/progress.h"
#include "tools/lab/commands/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpa {
namespace {

struct AccuracyCommand {
    AccuracyOptions accuracy;
    std::vector<std::string> ranges;  // as typed; none: the options' own
    bool json = false;
};

std::array<double, 2> range_called(const std::string& text) {
    const std::size_t colon = text.find(':');
    const auto lo = find_real(text.substr(0, colon));
    const auto hi = find_real(colon == std::string::npos ? "" : text.substr(colon + 1));
    if (!lo || !hi) {
        throw LoadError({"--ranges"},
                        fmt::format("'{}' is not a range; expected WEAKEST:STRONGEST in pN", text));
    }
    return {*lo, *hi};
}

nlohmann::ordered_json as_json(const AccuracyResult& r) {
    const AccuracyReport report = r.summary.accuracy.value_or(AccuracyReport{});
    return {{"range_pN", r.range_pN},
            {"within_pN", r.within_pN},
            {"ends_N", report.ends_newton},
            {"largest_hand_N", r.largest_hand_N},
            {"stiffest_share_of_cap", report.stiffest_share},
            {"samples", r.errors_pN.size()},
            {"within_share", r.within_share},
            {"error_90_pN", r.ninety_pN},
            {"errors_pN", r.errors_pN},
            {"reference_moving_pN", r.moving_pN},
            {"error_estimates", report.estimates},
            {"estimates_within_share", report.within_share},
            {"estimates_error_90_pN", report.ninety_pN},
            {"active_mean", report.active},
            {"steps_mean", report.steps},
            {"step_median_us", r.summary.step_median_us},
            {"largest_cap_ratio", report.largest_cap_ratio},
            {"not_met", find_unmet(report).all()},
            {"unsaid", r.unsaid()}};
}

void print_accuracy_header() {
    fmt::print(
        "| range, pN | within, pN | felt at both ends, N | at most, N | of the cap, % | samples "
        "within, % | 90 %, pN | still moving, pN | estimates: 90 %, pN | active | steps | step, ms "
        "| "
        "not met |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
}

void print_row(const AccuracyResult& r) {
    const AccuracyReport report = r.summary.accuracy.value_or(AccuracyReport{});
    const std::vector<std::string> not_met = find_unmet(report).all();
    fmt::print(
        "| {:.6g} to {:.6g} | {:.6g} | {:.3f}, {:.3f} | {:.2f} | {:.1f} | {:.0f} | {:.3g} | {:.3g} "
        "| {} | "
        "{:.0f} | {:.1f} | {:.3g} | {} |\n",
        r.range_pN[0], r.range_pN[1], r.within_pN, report.ends_newton[0], report.ends_newton[1],
        r.largest_hand_N, 100 * report.stiffest_share, 100 * r.within_share, r.ninety_pN,
        r.moving_pN, report.estimates > 0 ? fmt::format("{:.3g}", report.ninety_pN) : "",
        report.active, report.steps, 1e-3 * r.summary.step_median_us,
        not_met.empty() ? "nothing" : fmt::format("{}", fmt::join(not_met, "; ")));
    for (const std::string& what : r.unsaid()) fmt::print(stderr, "not reported: {}\n", what);
    std::fflush(stdout);
}

// The exit code: 1 where a requirement was not met and the run did not report it.
int run_accuracy(const AccuracyCommand& command) {
    AccuracyOptions options = command.accuracy;
    if (!command.ranges.empty()) options.ranges_pN.clear();
    for (const std::string& text : command.ranges) options.ranges_pN.push_back(range_called(text));
    check_accuracy(options);
    CountLine line;
    const std::size_t count = options.ranges_pN.size() * options.tolerances_pN.size();
    if (!command.json) print_accuracy_header();
    std::vector<AccuracyResult> results;
    for (const std::array<double, 2>& range_pN : options.ranges_pN) {
        for (const double within_pN : options.tolerances_pN) {
            line.show(fmt::format("{} of {}", results.size() + 1, count));
            results.push_back(play_accuracy(options, range_pN, within_pN));
            if (!command.json) print_row(results.back());
        }
    }
    const auto unsaid =
        std::ranges::count_if(results, [](const AccuracyResult& r) { return !r.unsaid().empty(); });
    if (command.json) {
        nlohmann::ordered_json report{{"count", results.size()}, {"unsaid", unsaid}};
        for (const AccuracyResult& result : results) report["rows"].push_back(as_json(result));
        fmt::print("{}\n", report.dump(2));
    }
    return unsaid == 0 ? 0 : 1;
}

}  // namespace

void add_accuracy(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& accuracy = *program.add_subcommand(
        "accuracy",
        "Compare the force sent to the hand with a reference, by force range and tolerance");
    AccuracyCommand& command = own_options<AccuracyCommand>(accuracy, chosen, run_accuracy);
    AccuracyOptions& options = command.accuracy;
    describe(
        accuracy,
        {"palpa-lab accuracy scenes/water --ranges 20:3000,50:400 --tolerances 0.001,1",
         "palpa-lab accuracy scenes/hiv/flexible.toml --ranges 500:20000 --tolerances 100,1000 "
         "--samples 10"});
    accuracy.add_option("scene", options.scene, "scene folder or file")->required();
    accuracy
        .add_option("--ranges", command.ranges,
                    "force ranges WEAKEST:STRONGEST in pN (default 20:3000,50:10000,200:5000)")
        ->delimiter(',');
    accuracy
        .add_option("--tolerances", options.tolerances_pN,
                    "largest allowed errors in pN (default 50,150,500)")
        ->delimiter(',')
        ->check(in_range(1e-6, 1e6));
    accuracy
        .add_option("--samples", options.samples,
                    "ticks of each stroke compared with the reference (default 20)")
        ->check(in_range(1, 1e6));
    add_setting(accuracy, "--seconds", "length of the run", options.settings);
    accuracy.add_flag("--json", command.json, "print the results as JSON");
    add_set_option(accuracy, options.settings);
}

}  // namespace palpa
