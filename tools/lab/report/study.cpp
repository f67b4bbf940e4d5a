// Figures 7 and 8: how well and how soon emulated operators find the place without force.
#include "experiments/study.h"
#include "core/units.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/probe.h"
#include "tools/lab/experiments/study_operators.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>

namespace palpa {
namespace {

// As in the paper: variable force red, constant force blue, none green.
constexpr int colour_of(CouplingMode mode) {
    switch (mode) {
        case CouplingMode::VariableForceVariableDisplacement:
        case CouplingMode::VariableForceConstantDisplacement:
            return 0xc0392b;
        case CouplingMode::ConstantForceVariableDisplacement:
        case CouplingMode::ConstantForceConstantDisplacement:
            return 0x1f5fa8;
        case CouplingMode::NoForce:
            return 0x1e8449;
        case CouplingMode::Guarded:
            break;
    }
    return 0x8e44ad;
}

std::string name_of(CouplingMode mode) {
    return std::string(coupling_mode_names[static_cast<std::size_t>(mode)]);
}

// Means as bars, half a standard deviation on either side, its value beside it.
std::string format_bars(const std::string& name, const std::vector<StudyRow>& rows,
                        Spread StudyRow::* value, int digits) {
    std::string text = "$" + name + " << EOD\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Spread& spread = rows[i].*value;
        const double deviation = spread.deviation.value_or(0);
        text +=
            fmt::format("{} {:.6g} {:.6g} {} \"({:.{}f})\" \"{}\"\n", i, spread.mean, deviation / 2,
                        colour_of(rows[i].mode), deviation, digits, name_of(rows[i].mode));
    }
    return text + "EOD\n";
}

constexpr const char* bars = R"(set multiplot layout 1,2
unset key
set style fill solid 0.8
set boxwidth 0.6
set xlabel 'mode'
set yrange [0:*]
set offsets 0,0,graph 0.12,0
set ylabel 'mean distance (Å)'
plot $distance using 1:2:4:xtic(6) with boxes lc rgb variable, \
     '' using 1:2:3 with yerrorbars ps 0 lw 1.5 lc rgb 'black', \
     '' using 1:($2+$3):5 with labels offset 0,0.7
set ylabel 'mean time (s)'
plot $time using 1:2:4:xtic(6) with boxes lc rgb variable, \
     '' using 1:2:3 with yerrorbars ps 0 lw 1.5 lc rgb 'black', \
     '' using 1:($2+$3):5 with labels offset 0,0.7
unset multiplot
)";

std::string draw_figure_8(const OperatorStudyOptions& study,
                          const std::vector<StudyResult>& results, std::size_t participant) {
    const SceneDescription scene = read_study_scene(study, {});
    const World world = load_world(scene);
    const double rest = find_rest(scene, world);
    std::vector<std::vector<double>> line;
    for (int i = -40; i <= 250; ++i) {
        const double distance = rest + 0.01 * i;
        line.push_back({distance, force_along_line_at(world, distance).force *
                                      units::newton_per_kcal_per_mol_angstrom * 1e9});
    }
    std::string script = format_data("line", line);
    std::string plots = "$line with lines lw 2 lc rgb '#555555' title 'force'";
    double level = -0.45;
    for (const CouplingMode mode : study.modes) {
        std::vector<std::vector<double>> found;
        for (const StudyResult& r : results) {
            if (r.trial.mode == mode && r.trial.participant == participant)
                found.push_back({r.found_angstrom, level});
        }
        level -= 0.09;
        if (found.empty()) continue;
        const std::string name = "mode_" + name_of(mode);
        script += format_data(name, found);
        plots += fmt::format(", ${} with points pt 7 ps 0.8 lc rgb '#{:06x}' title 'mode {}'", name,
                             colour_of(mode), name_of(mode));
    }
    script += fmt::format(R"(set xlabel 'distance (Å)'
set ylabel 'force (nN), + repels'
set xrange [{:.3f}:{:.3f}]
set yrange [{:.3f}:1]
set key outside right
set arrow from {}, graph 0 to {}, graph 1 nohead dt 2 lw 1.5
set arrow from graph 0, first 0 to graph 1, first 0 nohead dt 2 lw 1.5
plot )",
                          rest - 0.4, rest + 2.5, level - 0.1, rest, rest) +
              plots + "\n";
    return draw_figure(script,
                       "Figure 8: where one operator believed that place to be, each mode "
                       "on a level of its own; dashed, where it is.",
                       {900, 460});
}

// What guarded coupling has to be against mode 4, constant gains.
std::string hold_against_mode_4(const std::vector<StudyRow>& rows, bool& is_met) {
    const auto row_of = [&](CouplingMode mode) {
        return *std::ranges::find(rows, mode, &StudyRow::mode);
    };
    const StudyRow guarded = row_of(CouplingMode::Guarded);
    const StudyRow constant = row_of(CouplingMode::ConstantForceConstantDisplacement);
    const double ratio = guarded.distance_angstrom.mean / constant.distance_angstrom.mean;
    const double later_s = guarded.time_s.mean - constant.time_s.mean;
    is_met = ratio <= 1.0 / 3 && later_s <= 2 && guarded.finished_share == 1;
    return fmt::format(
        "<p>Guarded against mode 4: {:.2f} of the distance (limit 1/3), {:+.1f} s (limit +2 s), "
        "{:.0f} "
        "% "
        "finished (limit all): {}.</p>\n",
        ratio, later_s, 100 * guarded.finished_share,
        is_met ? "met" : "<span class=\"missed\">missed</span>");
}

}  // namespace

ReportSection report_figures_7_and_8(const ReportOptions& options) {
    OperatorStudyOptions study;
    study.scene = options.scene;
    study.settings = options.settings;
    study.operators = options.quick ? 5 : 20;
    study.rounds = options.quick ? 1 : 3;
    study.seed = options.seed;
    check_study(study);
    const std::vector<StudyResult> results =
        play_study(study, [&](std::size_t done, std::size_t of) {
            if (done % 60 == 0) report_progress(fmt::format("{} of {} trials", done, of));
        });
    const std::vector<StudyRow> rows = summarise_study(study.modes, results);
    std::vector<StudyRow> with_force;
    std::ranges::copy_if(rows, std::back_inserter(with_force),
                         [](const StudyRow& row) { return row.mode != CouplingMode::NoForce; });

    ReportSection section{"figures-7-8", "Figures 7 and 8: finding the place without force"};
    section.shows = fmt::format(
        "{} emulated operators, {} times each mode: mean distance from the place where the force "
        "is 0, and mean time; deviations at half their size, their values in parentheses.",
        study.operators, study.rounds);
    std::string caption = "Figure 7, left without mode 5, as in the paper.";
    std::vector<std::vector<std::string>> table{
        {"mode", "distance (Å)", "deviation", "time (s)", "finished", "through"}};
    for (const StudyRow& row : rows) {
        table.push_back({name_of(row.mode), fmt::format("{:.4f}", row.distance_angstrom.mean),
                         fmt::format("{:.4f}", row.distance_angstrom.deviation.value_or(0)),
                         fmt::format("{:.1f}", row.time_s.mean),
                         fmt::format("{:.0f} %", 100 * row.finished_share),
                         fmt::format("{:.0f} %", 100 * row.through_share)});
        if (row.mode == CouplingMode::NoForce) {
            caption += fmt::format(" Mode 5: {:.3f} Å ({:.3f}).", row.distance_angstrom.mean,
                                   row.distance_angstrom.deviation.value_or(0));
        }
    }
    section.body =
        draw_figure(format_bars("distance", with_force, &StudyRow::distance_angstrom, 3) +
                        format_bars("time", rows, &StudyRow::time_s, 1) + bars,
                    caption) +
        draw_figure_8(study, results, 1) + format_table(table) +
        hold_against_mode_4(rows, section.meets_limits);
    section.differs =
        "The paper asked five people three times. Here emulated operators follow a rule with a "
        "force threshold: compare ratios between modes, not distances. In mode 5 the error of the "
        "operator is not simulated but set to the spread that the paper reports; this row is an "
        "input, not a result. Guarded coupling is not a mode of the paper.";
    section.command =
        fmt::format("palpa-lab study {} --operators {} --rounds {} --seed {}",
                    options.scene.string(), study.operators, study.rounds, options.seed);
    return section;
}

}  // namespace palpa
