// Figures 1, 4, 5 and 6: what two waters do to each other, the gains, and strokes through both.
#include "core/units.h"
#include "haptics/gains.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/coupling.h"
#include "simulation/probe.h"
#include "tools/lab/experiments/axis_run.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>

namespace palpa {
namespace {

constexpr double nN = units::newton_per_kcal_per_mol_angstrom * 1e9;
const std::vector<std::string> paper_settings{"mode=1", "period_ms=14", "seconds=8"};
const std::vector<std::string> guarded_settings{"mode=guarded", "period_ms=14", "seconds=8"};

// Time, both forces, gain and distance; every tenth tick, or a page would be megabytes.
std::string data_of(const std::string& name, const AxisRun& played) {
    constexpr std::size_t every = 10;
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i < played.readings.size(); i += every) {
        const Reading& r = played.readings[i];
        rows.push_back(
            {r.time_s, r.molecular_nN, r.hand_N, r.displacement_gain, r.distance_angstrom});
    }
    return format_data(name, rows);
}

AxisRun play_with(const ReportOptions& options, const std::vector<std::string>& settings) {
    return play_axis({options.scene, settings_of(options, settings)});
}

std::string describe(const AxisRun& played) {
    return fmt::format(
        "largest repulsion {:.2f} nN, attraction felt {:.2f} N, at the clamp for {} ms, {:+.2f} mJ "
        "given to the hand, {:.2f} Å at the closest, {:.2f} Å in the end",
        played.largest_nN, played.attraction_N, played.at_clamp, played.energy_J * 1e3,
        played.closest_angstrom, played.last_angstrom);
}

constexpr const char* two_forces = R"(set multiplot layout 1,2
set xzeroaxis lt -1
set ytics nomirror
set y2tics
set xlabel 'time (s)'
set ylabel 'force on the molecule F_m (nN)' tc rgb '#c0392b'
set y2label 'force on the hand F_h (N)' tc rgb '#1f5fa8'
set yrange [-2:5]
set y2range [-1.5:3.75]
set key top left
set title 'mode 1, as printed'
plot $paper using 1:2 with lines lw 1.5 lc rgb '#c0392b' title 'F_m', \
     $paper using 1:3 axes x1y2 with lines lw 1.5 lc rgb '#1f5fa8' title 'F_h'
set title 'guarded'
plot $guarded using 1:2 with lines lw 1.5 lc rgb '#c0392b' title 'F_m', \
     $guarded using 1:3 axes x1y2 with lines lw 1.5 lc rgb '#1f5fa8' title 'F_h'
unset multiplot
)";

constexpr const char* gain_and_distance = R"(set multiplot layout 1,2
set ytics nomirror
set y2tics
set xlabel 'time (s)'
set ylabel 'A_d (10^9)' tc rgb '#1e8449'
set y2label 'distance (Å)' tc rgb '#555555'
set y2range [2:8]
unset key
set title 'mode 1, as printed'
plot $paper using 1:($4/1e9) with lines lw 1.5 lc rgb '#1e8449' title 'A_d', \
     $paper using 1:5 axes x1y2 with lines lw 1.5 lc rgb '#555555' title 'distance'
set title 'guarded'
plot $guarded using 1:($4/1e9) with lines lw 1.5 lc rgb '#1e8449' title 'A_d', \
     $guarded using 1:5 axes x1y2 with lines lw 1.5 lc rgb '#555555' title 'distance'
unset multiplot
)";

}  // namespace

ReportSection report_figure_1(const ReportOptions& options) {
    const SceneDescription scene = read_scene(options.scene, options.settings);
    const World world = load_world(scene);
    std::vector<std::vector<double>> line;
    double deepest = 0, deepest_at = 0, most = 0, most_at = 0;
    for (int i = 0; i <= 1160; ++i) {
        const double distance = 2.4 + 0.005 * i;
        const LineForce at = force_along_line_at(world, distance);
        line.push_back({distance, at.energy, at.force * nN});
        if (at.energy < deepest) deepest = at.energy, deepest_at = distance;
        if (at.force * nN < most) most = at.force * nN, most_at = distance;
    }
    const AxisRun played = play_with(options, guarded_settings);

    ReportSection section{"figure-1",
                          "Figure 1: molecular interaction between two water molecules"};
    section.shows = fmt::format(
        "One water is led to the other and back: the force on it over time, and energy and force "
        "over the distance of the oxygens. The deepest energy is {:.3f} kcal/mol at {:.3f} Å, the "
        "strongest attraction {:.3f} nN at {:.2f} Å.",
        deepest, deepest_at, -most, most_at);
    section.body = draw_figure(
        data_of("stroke", played) + format_data("line", line) + R"(set multiplot layout 1,2
set xzeroaxis lt -1
unset key
set xlabel 'time (s)'
set ylabel 'F_m (nN), + repels'
plot $stroke using 1:2 with lines lw 1.5 lc rgb '#c0392b'
set xlabel 'distance (Å)'
set xrange [2.4:8]
set yrange [-0.5:3.5]
set ytics nomirror
set y2tics
set y2range [-7:49]
set y2label 'energy (kcal/mol)' tc rgb '#555555'
plot $line using 1:3 with lines lw 1.5 lc rgb '#c0392b', \
     $line using 1:2 axes x1y2 with lines lw 1.5 lc rgb '#555555'
unset multiplot
)",
        "Left as in the paper, F_m over time. Right: F_m (red) and energy (grey) over distance.");
    section.differs =
        "In the paper a person moved the hand, here a script does. The paper reports an attraction "
        "below 0.35 nN for an orientation that it does not state; here it is that of the strongest "
        "bond.";
    section.command = run_command_of(options, guarded_settings);
    return section;
}

ReportSection report_figure_4(const ReportOptions& options) {
    const SceneDescription scene = read_scene(options.scene, settings_of(options, {"mode=1"}));
    const CouplingLaws laws = build_coupling_laws(scene.coupling);
    std::vector<std::vector<double>> force, gain;
    for (int i = -500; i <= 500; ++i) {
        const double F_m = i * 2e-11;
        force.push_back({F_m * 1e9, hand_force(laws.force, F_m)});
    }
    for (int i = -500; i <= 500; ++i) {
        const double F_m = i * 2e-13;
        gain.push_back({F_m * 1e12, displacement_gain(laws.displacement, F_m) / 1e9});
    }
    const double slope = hand_force_slope(laws.force, 0), F_0 = scene.coupling.F_0_nN * 1e-9;

    ReportSection section{"figure-4", "Figure 4: profile of the force amplification, and eq. 3"};
    section.shows = fmt::format(
        "F_h over F_m by eq. 2 with F_h1 = {} N, F_h2 = {} N, F_0 = {} nN, A_fmin = {:.2f}·10⁹, "
        "A_fmax = {:.2f}·10⁹; beside it A_d by eq. 3.",
        scene.coupling.F_h1_N, scene.coupling.F_h2_N, scene.coupling.F_0_nN,
        scene.coupling.A_f_min / 1e9, scene.coupling.A_f_max / 1e9);
    section.body =
        draw_figure(format_data("force", force) + format_data("gain", gain) +
                        R"(set multiplot layout 1,2
set xzeroaxis lt -1
unset key
set xlabel 'F_m (nN)'
set ylabel 'F_h (N)'
set yrange [-3:3]
plot $force with lines lw 2 lc rgb '#1f5fa8'
set autoscale y
set xlabel 'F_m (pN)'
set ylabel 'A_d (10^9)'
plot $gain with lines lw 2 lc rgb '#1e8449'
unset multiplot
)",
                    "Left: eq. 2 as in the paper. Right: eq. 3, which the paper does not plot.");
    section.differs = fmt::format(
        "The curve is the printed formula: its slope is {:.3f}·10⁹ at 0, not A_fmax, and "
        "{:.3f}·10⁹ at F_0, not A_fmin; at F_0 it gives {:.3f} N, not F_h1 + A_fmin F_0.",
        slope / 1e9, hand_force_slope(laws.force, F_0) / 1e9, hand_force(laws.force, F_0));
    section.command = "palpa-lab report";
    return section;
}

ReportSection report_figure_5(const ReportOptions& options) {
    const AxisRun paper = play_with(options, paper_settings);
    const AxisRun guarded = play_with(options, guarded_settings);
    ReportSection section{"figure-5", "Figure 5: interactions using variable force amplification"};
    section.shows =
        "F_m and F_h over time, T_s = 14 ms, medium hand: the attraction is felt, the repulsion is "
        "not cut off.";
    section.body =
        draw_figure(data_of("paper", paper) + data_of("guarded", guarded) + two_forces,
                    fmt::format("Mode 1: {}. Guarded: {}.", describe(paper), describe(guarded)));
    section.differs =
        "The paper shows mode 1 with a person's hand and no oscillation; mode 1 stands beside "
        "guarded coupling here, on the same device, hand and stroke.";
    section.command = run_command_of(options, paper_settings);
    return section;
}

ReportSection report_figure_6(const ReportOptions& options) {
    const AxisRun paper = play_with(options, paper_settings);
    const AxisRun guarded = play_with(options, guarded_settings);
    ReportSection section{"figure-6",
                          "Figure 6: interactions using variable displacement amplification"};
    section.shows =
        "A_d, handle travel for molecule travel, and the distance over time in the strokes of "
        "figure 5: little handle travel far away, much of it in contact.";
    section.body =
        draw_figure(data_of("paper", paper) + data_of("guarded", guarded) + gain_and_distance,
                    "γ = 10·10¹¹ /N, F_off = 20 pN, A_dmin = 0.005·10⁹, A_dmax = 0.25·10⁹.");
    section.differs =
        "By eq. 3 A_d falls to A_dmin at the place of rest too, where F_m is 0, and not only far "
        "away. Guarded coupling has no such gap, and raises A_d above A_dmax where the molecule is "
        "stiff. The paper draws the forces, which figure 5 has.";
    section.command = run_command_of(options, guarded_settings);
    return section;
}

}  // namespace palpa
