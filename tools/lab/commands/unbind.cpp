// palpa-lab unbind: takes a molecule out of its pocket and back; a row for each hand, period and
// mode.
#include "tools/lab/experiments/unbinding.h"

#include "tools/commands/progress.h"
#include "tools/lab/commands/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace palpa {
namespace {

struct UnbindCommand {
    UnbindingOptions unbinding;
    bool json = false;
};

nlohmann::ordered_json as_json(const UnbindingResult& r) {
    nlohmann::ordered_json json{{"active", r.active},
                                {"period_ms", r.period_ms},
                                {"grip", r.grip},
                                {"mode", r.mode},
                                {"net_work_J", r.summary.net_work_J},
                                {"error_N", r.error_N},
                                {"off_J", r.off_J},
                                {"off_at_limits_J", r.off_at_limits_J},
                                {"cut_share", r.cut_share},
                                {"clamped_share", r.summary.clamped_share},
                                {"safety_share", r.summary.safety_share},
                                {"clutches", r.clutches},
                                {"step_median_us", r.summary.step_median_us},
                                {"wall_s", r.wall_s},
                                {"meets_limits", r.meets_limits()},
                                {"out", r.is_out()},
                                {"back", r.is_back()},
                                {"settings", r.settings}};
    if (r.ripple_N) json["ripple_N"] = *r.ripple_N;
    if (r.out_s) json["out_s"] = *r.out_s;
    if (r.back_s) json["back_s"] = *r.back_s;
    if (const auto& unbinding = r.summary.unbinding) {
        json["farthest_angstrom"] = unbinding->farthest;
        json["clearance_angstrom"] = unbinding->clearance;
        json["closest_angstrom"] = unbinding->closest;
        json["last_rmsd_angstrom"] = unbinding->last_rmsd;
        json["last_backbone_rmsd_angstrom"] = unbinding->last_backbone;
        json["last_pocket_rmsd_angstrom"] = unbinding->last_pocket;
    }
    return json;
}

void print_unbinding_header() {
    fmt::print(
        "| active | T_s, ms | hand | mode | ripple, N | net work, J | off, mJ | at limits, mJ | "
        "error, N | cut, % "
        "| safety, % | nearest, Å | out, Å | after, s | back, Å | after, s | clutches | step, ms "
        "|\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "| --- | --- | --- |\n");
}

void print_row(const UnbindingResult& r) {
    const Summary& s = r.summary;
    const UnbindingPath unbinding = s.unbinding.value_or(UnbindingPath{});
    const auto seconds = [](const std::optional<double>& at_s) {
        return at_s ? fmt::format("{:.1f}", *at_s) : std::string{};
    };
    fmt::print(
        "| {} | {} | {} | {} | {} | {:+.4f} | {:+.1f} | {:+.1f} | {:.3f} | {:.1f} | {:.0f} | "
        "{:.2f} | "
        "{}{:.1f} | {} | {}{:.2f} | {} | {} | {:.1f} |\n",
        r.active < StaticsDescription{}.active ? fmt::format("{}", r.active) : "all", r.period_ms,
        r.grip, r.mode, r.ripple_N ? fmt::format("{:.3f}", *r.ripple_N) : std::string{},
        s.net_work_J, 1e3 * r.off_J, 1e3 * r.off_at_limits_J, r.error_N, 100 * r.cut_share,
        100 * s.safety_share, unbinding.closest, r.is_out() ? "yes, " : "no, ", unbinding.farthest,
        seconds(r.out_s), r.is_back() ? "yes, " : "no, ", unbinding.last_rmsd, seconds(r.back_s),
        r.clutches, 1e-3 * s.step_median_us);
    std::fflush(stdout);
}

// The exit code: 1 where a guarded one misses a limit.
int run_unbind(const UnbindCommand& command) {
    const UnbindingOptions& options = command.unbinding;
    const std::vector<std::vector<std::string>> choices = list_unbindings(options);
    CountLine line;
    if (!command.json) print_unbinding_header();
    std::vector<UnbindingResult> results;
    for (const std::vector<std::string>& choice : choices) {
        line.show(fmt::format("{} of {}", results.size() + 1, choices.size()));
        results.push_back(play_unbinding(options, choice));
        if (!command.json) print_row(results.back());
    }
    const auto count = [&](auto&& holds) { return std::ranges::count_if(results, holds); };
    const auto is_guarded = [](const UnbindingResult& r) { return r.is_guarded(); };
    const auto out = count([](const UnbindingResult& r) { return r.is_out(); });
    const auto back = count([](const UnbindingResult& r) { return r.is_back(); });
    const auto missed =
        count([&](const UnbindingResult& r) { return is_guarded(r) && !r.meets_limits(); });
    if (command.json) {
        nlohmann::ordered_json report{
            {"count", results.size()}, {"out", out}, {"back", back}, {"missed", missed}};
        for (const UnbindingResult& result : results) report["journeys"].push_back(as_json(result));
        fmt::print("{}\n", report.dump(2));
    } else {
        fmt::print(
            "\n{} of {} out, {} back; {} of {} guarded ones missed a limit (ripple {} N, nothing "
            "cut at 3 nN or less, finite, none through, out where the stroke leads 10 Å and all "
            "moves)\n",
            out, results.size(), back, missed, count(is_guarded), most_unbinding_ripple_N);
        for (const UnbindingResult& r : results) {
            if (!is_guarded(r) || r.meets_limits()) continue;
            fmt::print("palpa run --headless {} --set \"{}\"\n", options.scene.string(),
                       fmt::join(r.settings, "\" --set \""));
        }
    }
    return missed == 0 ? 0 : 1;
}

}  // namespace

void add_unbind(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& unbinding = *program.add_subcommand(
        "unbind",
        "Take a molecule out of its pocket and back, for several hands, periods and modes");
    UnbindCommand& command = own_options<UnbindCommand>(unbinding, chosen, run_unbind);
    UnbindingOptions& options = command.unbinding;
    describe(unbinding, {"palpa-lab unbind scenes/hiv/flexible.toml --periods 14 --hands medium"});
    unbinding.add_option("scene", options.scene, "folder or file of a flexible scene")->required();
    CLI::Option* const periods =
        unbinding
            .add_option("--periods", options.periods_ms, "periods T_s in ms (default 1,14,83)")
            ->delimiter(',')
            ->check(in_range(1, 1e4));
    CLI::Option* const fastest =
        unbinding.add_flag("--fastest", options.fastest,
                           "also run at the shortest T_s that 99 % of steps keep on this machine");
    CLI::Option* const hands =
        unbinding.add_option("--hands", options.grips, "grips of the hand (default medium,firm)")
            ->delimiter(',');
    CLI::Option* const modes =
        unbinding.add_option("--modes", options.modes, "coupling modes (default guarded,4)")
            ->delimiter(',');
    CLI::Option* const active =
        unbinding
            .add_option("--active", options.active,
                        "active degrees of freedom, a number or all (default all)")
            ->delimiter(',')
            ->transform(CLI::Transformer(std::map<std::string, std::string>{
                {"all", fmt::format("{}", StaticsDescription{}.active)}}))
            ->check(in_range(0, 1e6));
    unbinding
        .add_option("--random", options.random,
                    "instead: run this many random hands, devices, periods, paths and numbers of "
                    "active joints")
        ->check(in_range(1, 1e6))
        ->excludes(periods)
        ->excludes(fastest)
        ->excludes(hands)
        ->excludes(modes)
        ->excludes(active);
    add_seed_option(unbinding, options.seed);
    unbinding.add_flag("--json", command.json, "print every path as JSON");
    add_set_option(unbinding, options.settings);
}

}  // namespace palpa
