// palpa-lab closed-paths: random closed paths of the hand in space; those that miss a limit, and a
// table of all.
#include "tools/lab/experiments/closed_paths.h"

#include "tools/commands/progress.h"
#include "tools/lab/commands/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpa {
namespace {

struct ClosedPathCommand {
    ClosedPathOptions paths;
    bool json = false;
};

void warn_of_cost(const ClosedPathOptions& options) {
    constexpr double most_s = 600;
    const ClosedPathCost one = find_closed_path_cost(options);
    const double all_s = one.seconds * static_cast<double>(options.count);
    if (all_s < most_s) return;
    fmt::print(stderr,
               "warning: the scene has {:.0f} pairs of atoms: one path takes about {:.2g} s, all "
               "take {:.2g} h\n",
               one.pairs, one.seconds, all_s / 3600);
}

nlohmann::ordered_json as_json(std::size_t number, const ClosedPathResult& r) {
    return {{"number", number},
            {"in_plane", r.in_plane},
            {"period_ms", r.period_ms},
            {"work_J", r.work_J},
            {"law_J", r.law_J},
            {"extra_J", r.extra_joule()},
            {"closed_law_J", r.closed_law_J},
            {"open_mm", r.open_mm},
            {"closure_angstrom", r.closure_angstrom},
            {"drift_angstrom", r.drift_angstrom},
            {"farthest_angstrom", r.farthest_angstrom},
            {"ripple_N", r.ripple_N},
            {"felt_share", r.felt_share},
            {"largest_N", r.largest_N},
            {"clipped_mm", r.clipped_mm},
            {"clamped_share", r.clamped_share},
            {"was_limited", r.was_limited},
            {"was_held_back", r.was_held_back},
            {"settings", r.settings}};
}

// Median, 90 %, most as cells of a table; empty where there is no value.
std::string format_spread(std::vector<double> values) {
    if (values.empty()) return " | | ";
    std::ranges::sort(values);
    const auto at = [&](double share) {
        return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    return fmt::format("{:.3g} | {:.3g} | {:.3g}", at(0.5), at(0.9), at(1));
}

// A row of the table: which paths count, and their value.
struct Row {
    const char* what;
    double scale;
    std::string limit;
    bool (*counts)(const ClosedPathResult&);
    double (*value)(const ClosedPathResult&);
};

void print_table(const std::vector<ClosedPathResult>& all, bool turned) {
    const auto free = [](const ClosedPathResult& r) { return !r.was_limited; };
    const auto near = [](const ClosedPathResult& r) {
        return !r.was_limited && r.farthest_angstrom <= near_angstrom;
    };
    const auto any = [](const ClosedPathResult&) { return true; };
    const std::string energy_bar = turned ? "" : fmt::format("{}", 1e3 * most_extra_J);
    const std::array rows = std::to_array<Row>({
        {"work beyond the continuous law's, in the plane, mJ", 1e3, energy_bar,
         [](const ClosedPathResult& r) { return !r.was_limited && r.in_plane; },
         [](const ClosedPathResult& r) { return std::abs(r.extra_joule()); }},
        {"the same in space, mJ", 1e3, energy_bar,
         [](const ClosedPathResult& r) { return !r.was_limited && !r.in_plane; },
         [](const ClosedPathResult& r) { return std::abs(r.extra_joule()); }},
        {"generated, at the stop or at the thermal limit, mJ", 1e3, energy_bar,
         [](const ClosedPathResult& r) { return r.was_limited; },
         [](const ClosedPathResult& r) { return r.extra_joule(); }},
        {"work of the continuous law, brought home, mJ", 1e3, "", free,
         [](const ClosedPathResult& r) { return std::abs(r.closed_law_J); }},
        {"drift beyond the continuous law's, inside of 6 Å, Å", 1,
         turned ? "" : fmt::format("{}", most_drift_angstrom), near,
         [](const ClosedPathResult& r) { return r.drift_angstrom; }},
        {"the same outside, Å", 1, "",
         [](const ClosedPathResult& r) {
             return !r.was_limited && r.farthest_angstrom > near_angstrom;
         },
         [](const ClosedPathResult& r) { return r.drift_angstrom; }},
        {"from begin to end by the continuous law, brought home, Å", 1, "", near,
         [](const ClosedPathResult& r) { return r.closure_angstrom; }},
        {"ripple at rest, N", 1, fmt::format("{}", most_closed_path_ripple_N), any,
         [](const ClosedPathResult& r) { return r.ripple_N; }},
        {"stiffest felt, of the cap", 1, fmt::format("{}", most_felt_share), any,
         [](const ClosedPathResult& r) { return r.felt_share; }},
        {"largest force on the hand, N", 1, "", any,
         [](const ClosedPathResult& r) { return r.largest_N; }},
    });
    fmt::print(
        "| what | paths | median | 90 % | most | limit |\n| --- | --- | --- | --- | --- | --- |\n");
    for (const Row& row : rows) {
        std::vector<double> values;
        for (const ClosedPathResult& result : all)
            if (row.counts(result)) values.push_back(row.scale * row.value(result));
        fmt::print("| {} | {} | {} | {} |\n", row.what, values.size(), format_spread(values),
                   row.limit);
    }
}

// The exit code: 1 where a limit is missed.
int run_closed_paths(const ClosedPathCommand& command) {
    const ClosedPathOptions& options = command.paths;
    check_closed_paths(options);
    warn_of_cost(options);
    CountLine count;
    const std::size_t last = options.first + options.count;
    const std::vector<ClosedPathResult> results =
        play_closed_paths(options, [&](std::size_t number, const ClosedPathResult& r) {
            if (number % 20 == 0) count.show(fmt::format("{} of {}", number, last));
            if (meets_limits(r, options.turn) || command.json) return;
            fmt::print(
                "path {}: net work {:+.5f} J (continuous law {:+.5f} J); drift {:.3f} Å, out to "
                "{:.2f} Å; ripple {:.3f} N; stiffness {:.2f} of the cap{}\n  palpa run --headless "
                "{} --set \"{}\"\n",
                number, r.work_J, r.law_J, r.drift_angstrom, r.farthest_angstrom, r.ripple_N,
                r.felt_share, r.was_held_back ? ", limited by the safety chain" : "",
                options.scene.string(), fmt::join(r.settings, "\" --set \""));
        });
    count.wipe();
    const auto failed = static_cast<std::size_t>(std::ranges::count_if(
        results, [&](const ClosedPathResult& r) { return !meets_limits(r, options.turn); }));
    if (command.json) {
        nlohmann::ordered_json report{
            {"count", results.size()}, {"seed", options.seed}, {"failed", failed}};
        for (std::size_t i = 0; i < results.size(); ++i)
            report["loops"].push_back(as_json(options.first + i, results[i]));
        fmt::print("{}\n", report.dump(2));
    } else {
        fmt::print("{} closed paths, {} missed a limit\n\n", results.size(), failed);
        print_table(results, options.turn);
    }
    return failed == 0 ? 0 : 1;
}

}  // namespace

void add_closed_paths(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& closed_paths = *program.add_subcommand(
        "closed-paths",
        "Test passivity: does the coupling generate energy on random closed paths in space?");
    ClosedPathCommand& command =
        own_options<ClosedPathCommand>(closed_paths, chosen, run_closed_paths);
    ClosedPathOptions& options = command.paths;
    describe(closed_paths, {"palpa-lab closed-paths scenes/water/space.toml --count 100"});
    closed_paths.add_option("scene", options.scene, "scene folder or file")->required();
    closed_paths.add_option("--count", options.count, "number of paths (default 1000)")
        ->check(in_range(1, 1e7));
    closed_paths.add_option("--first", options.first, "number of the first path (default 0)")
        ->check(in_range(0, 1e12));
    add_seed_option(closed_paths, options.seed);
    closed_paths.add_flag("--json", command.json, "print every path as JSON");
    closed_paths.add_flag("--turn", options.turn,
                          "the handle also turns on its path (molecules with-handle)");
    add_set_option(closed_paths, options.settings);
}

}  // namespace palpa
