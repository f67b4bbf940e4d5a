// The map of stability: how large A_f/A_d may be at which period of the simulation, by the paper's
// equation 1, by the law of damping, by eigenvalues, and in the emulated loop itself.
#include "core/units.h"
#include "haptics/plant.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/probe.h"
#include "tools/lab/experiments/onset.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace palpa {
namespace {

constexpr std::array grips{HandGrip::None, HandGrip::Light, HandGrip::Medium, HandGrip::Firm};

double damping_of(HandGrip grip) {
    const std::optional<HandModel> hand = hand_model(grip);
    return DeviceDynamics{}.viscosity_N_s_per_m + (hand ? hand->damping_N_s_per_m : 0);
}

}  // namespace

ReportSection report_stability(const ReportOptions& options) {
    const World world = load_world(read_scene(options.scene, options.settings));
    const double k_e =
        force_along_line_at(world, equilibrium_distance(world).value_or(0)).stiffness *
        units::newton_per_metre_per_kcal_per_mol_angstrom2;
    std::vector<std::vector<double>> curves, points;
    for (int i = 0; i <= 60; ++i) {
        const double period_s = 1e-3 * std::pow(100.0, i / 60.0);
        std::vector<double> row{1e3 * period_s, stiffness_of_equation_1({}, period_s) / k_e,
                                damping_of(HandGrip::Medium) / (1.5 * period_s) / k_e};
        for (const HandGrip grip : grips)
            row.push_back(critical_stiffness(build_plant({}, hand_model(grip)), period_s) / k_e);
        curves.push_back(row);
    }
    const std::vector<std::uint64_t> periods_ms =
        options.quick ? std::vector<std::uint64_t>{1, 14, 83}
                      : std::vector<std::uint64_t>{1, 2, 5, 10, 14, 20, 33, 50, 83};
    std::vector<std::vector<std::string>> table{
        {"hand", "T_s", "eq. 1: M_h/T_s²", "B/(1.5 T_s)", "eigenvalues", "measured", "apart"}};
    double farthest = 0;
    for (const HandGrip grip : grips) {
        if (options.quick && grip != HandGrip::None && grip != HandGrip::Medium) continue;
        report_progress(
            fmt::format("boundary, hand {}", grip_names[static_cast<std::size_t>(grip)]));
        for (const std::uint64_t period_ms : periods_ms) {
            const double T = static_cast<double>(period_ms) * 1e-3;
            const double K = critical_stiffness(build_plant({}, hand_model(grip)), T);
            const double onset =
                find_onset(K / 1.5, K * 1.5, {.grip = grip, .period_ms = period_ms}, 6);
            farthest = std::max(farthest, std::abs(onset / K - 1));
            points.push_back({static_cast<double>(period_ms), onset / k_e});
            table.push_back({std::string(grip_names[static_cast<std::size_t>(grip)]),
                             fmt::format("{} ms", period_ms),
                             fmt::format("{:.4g}", stiffness_of_equation_1({}, T)),
                             fmt::format("{:.4g}", damping_of(grip) / (1.5 * T)),
                             fmt::format("{:.4g}", K), fmt::format("{:.4g}", onset),
                             fmt::format("{:+.1f} %", 100 * (onset / K - 1))});
        }
    }

    ReportSection section{"stability", "Stability: A_f/A_d against T_s"};
    section.shows = fmt::format(
        "The largest stable A_f/A_d for two waters at rest (k_e = {:.1f} N/m) without friction, "
        "from equation 1 of the paper, from the law for small damping, from the eigenvalues of the "
        "sampled loop, and measured where the emulated loop begins to vibrate. The table lists K = "
        "A_f k_e/A_d in N/m.",
        k_e);
    section.body =
        draw_figure(format_data("curves", curves) + format_data("points", points) +
                        R"(set logscale xy
set xrange [1:100]
set xlabel 'T_s (ms)'
set ylabel 'A_f/A_d'
set format y '10^{%T}'
set key outside right
plot $curves using 1:2 with lines lw 2 dt 2 lc rgb '#c0392b' title 'eq. 1', \
     $curves using 1:3 with lines lw 2 dt 3 lc rgb '#555555' title 'B/(1.5 T_s), medium', \
     $curves using 1:4 with lines lw 2 lc rgb '#8e44ad' title 'no hand', \
     $curves using 1:5 with lines lw 2 lc rgb '#1e8449' title 'light', \
     $curves using 1:6 with lines lw 2 lc rgb '#1f5fa8' title 'medium', \
     $curves using 1:7 with lines lw 2 lc rgb '#d68910' title 'firm', \
     $points with points pt 7 ps 0.8 lc rgb '#222222' title 'measured'
)",
                    "Lines of hands: eigenvalues. Above a line the loop vibrates.", {900, 460}) +
        format_table(table);
    section.meets_limits = farthest <= 0.05;
    section.differs = fmt::format(
        "Equation 1 includes neither hand nor damping; where its line is above the others, it "
        "allows loops that vibrate. Measured limits and eigenvalues differ by at most {:.1f} % "
        "(limit 5 %).",
        100 * farthest);
    section.command = "ctest --preset release -R 'the emulated loop begins to shake'";
    return section;
}

}  // namespace palpa
