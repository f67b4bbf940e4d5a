// What the kernels cost and how exact they are, beside programs that sum the same.
#include "tools/lab/bench/kernel.h"
#include "scene/read_scene.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>

namespace palpa {
namespace {

// What the script that times other programs prints; where it is not there, how to get it.
std::string compare_peers(const ReportOptions& options) {
    const std::filesystem::path script = "tools/lab/scripts/compare_peers";
    if (options.quick)
        return "<p>Other programs are timed without <code>--quick</code> only.</p>\n";
    if (!std::filesystem::exists(script)) {
        return "<p>Other programs are timed by <code>tools/lab/scripts/compare_peers</code> where "
               "the "
               "report "
               "is made in Palpa's own folder.</p>\n";
    }
    report_progress("other programs");
    const ProgramRun run = read_program({script.string(), "--rounds", "2"});
    const bool is_done = run.end.problem == 0 && run.end.status == 0;
    return fmt::format("<p>{}, on this machine:</p>\n<pre>{}</pre>\n",
                       is_done ? "Beside other programs" : "Other programs could not be timed",
                       escaped(is_done ? run.output : run.errors));
}

}  // namespace

ReportSection report_kernels(const ReportOptions& options) {
    std::vector<BenchRow> rows;
    const SceneDescription scene = read_scene(options.flexible);
    bench_force_field("flexible", scene, rows);
    std::vector<std::vector<std::string>> table{
        {"sum", "median (µs)", "least (µs)", "largest error of a force, of max(own, rms)"}};
    for (const BenchRow& row : rows) {
        table.push_back({escaped(row.name), fmt::format("{:.0f}", quantile(row.samples, 0.5)),
                         fmt::format("{:.0f}", *std::ranges::min_element(row.samples)),
                         fmt::format("{:.1e}", row.error.value_or(0))});
    }
    ReportSection section{"kernels", "Kernels: speed against error, beside other programs"};
    section.shows =
        "Energies and forces of all terms of the protease and its inhibitor in single precision, "
        "for each instruction set of this processor; errors are against double precision.";
    section.body = format_table(table) + compare_peers(options);
    section.differs = "The paper does not state the cost of its force field.";
    section.command = fmt::format("palpa-lab bench {} --kernel; tools/lab/scripts/compare_peers",
                                  options.flexible.string());
    return section;
}

}  // namespace palpa
