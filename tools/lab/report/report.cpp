#include "tools/lab/report/report.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/machine.h"
#include "core/version.h"
#include "loading/load.h"
#include "scene/find_scene.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "tools/lab/bench/bench.h"
#include "tools/lab/bench/row.h"
#include "tools/lab/report/criteria.h"
#include "tools/lab/report/sections.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>

namespace palpa {
namespace {

using SectionFunction = ReportSection (*)(const ReportOptions&);

ReportSection report_without_flexible(const ReportOptions& options) {
    ReportSection section{"figure-9", "Figure 9 is left out"};
    section.shows = escaped(options.flexible.string()) + " is not there.";
    return section;
}

std::vector<SectionFunction> list_sections(const ReportOptions& options) {
    std::vector<SectionFunction> sections{
        report_figure_1, report_figure_4,   report_figure_5,
        report_figure_6, report_acceptance, report_stability,
        report_energy,   report_hard,       report_figures_7_and_8};
    if (std::filesystem::exists(options.flexible)) {
        sections.push_back(report_figure_9);
        sections.push_back(report_speed);
        sections.push_back(report_answers);
        sections.push_back(report_kernels);
    } else {
        sections.push_back(report_without_flexible);
    }
    return sections;
}

std::vector<std::pair<std::string, std::string>> list_facts(const ReportOptions& options,
                                                            double seconds) {
    return {{"program", fmt::format("palpa {} ({})", version_name, commit_name)},
            {"machine", machine_name()},
            {"date", fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))},
            {"took", fmt::format("{:.0f} s{}", seconds, options.quick ? ", quick" : "")},
            {"seed", fmt::format("{}", options.seed)},
            {"settings", options.settings.empty()
                             ? "the scene's own"
                             : fmt::format("{}", fmt::join(options.settings, " "))}};
}

// Everything that would be found out only after minutes; with what to write the page.
Existing check(const ReportOptions& options) {
    check_gnuplot();
    const SceneDescription scene = read_scene(options.scene, options.settings);
    if (coupling_of(scene, 0).mode != CouplingMode::Guarded) {
        throw LoadError(scene.place_of("coupling.mode"),
                        "the limits of the report apply to guarded coupling; expected "
                        "coupling.mode = \"guarded\"");
    }
    const World world = load_world(scene);
    if (moves_in_space(world) || has_mobile(world) || !equilibrium_distance(world)) {
        throw LoadError(scene.place_of("grab.molecule"),
                        "has no place without force on a line; expected a scene of one axis such "
                        "as scenes/water");
    }
    if (std::filesystem::exists(options.flexible)) {
        const SceneDescription flexible = read_scene(options.flexible);
        if (!flexible.has_statics()) {
            throw LoadError({options.flexible.string()},
                            "no molecule of this scene moves by itself; expected a flexible scene "
                            "such as scenes/hiv/flexible.toml");
        }
    }
    if (const std::optional<ClosedPathOptions> paths = find_closed_paths(options))
        check_closed_paths(*paths);
    return check_output(options.output, page_mark, options.overwrites);
}

// The path itself where there is no such scene.
std::filesystem::path find_flexible(const std::filesystem::path& named) {
    try {
        return find_scene_file(named);
    } catch (const LoadError&) {
        return named;
    }
}

}  // namespace

void report_progress(const std::string& what) {
    fmt::print(stderr, "  {}\n", what);
    (void)std::fflush(stderr);
}

int report_command(const ReportOptions& given) {
    ReportOptions options = given;
    options.flexible = find_flexible(given.flexible);
    const Existing existing = check(options);
    std::vector<ReportSection> sections;
    double total = 0;
    const auto functions = list_sections(options);
    for (const SectionFunction function : functions) {
        ReportSection section;
        const double seconds = seconds_of([&] { section = function(options); });
        section.seconds = seconds;
        total += seconds;
        fmt::print(stderr, "{} of {}: {}, {:.1f} s\n", sections.size() + 1, functions.size(),
                   section.title, seconds);
        sections.push_back(std::move(section));
    }
    write_text_file(options.output, format_page(list_facts(options, total), sections), existing);
    const bool is_met = std::ranges::all_of(sections, &ReportSection::meets_limits);
    fmt::print("written: {}{}\n", options.output.string(), is_met ? "" : "; a limit is missed");
    return is_met ? 0 : 1;
}

}  // namespace palpa
