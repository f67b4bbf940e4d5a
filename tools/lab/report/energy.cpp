// Energy that strokes in and out give to the hand, by design of the coupling and period, and a few
// starts and pushes that are hard.
#include "tools/lab/experiments/axis_run.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <array>
#include <string_view>

namespace palpa {
namespace {

constexpr std::array<std::string_view, 3> designs{"1", "2", "guarded"};
constexpr std::array<int, 4> periods_ms{1, 5, 14, 83};

}  // namespace

ReportSection report_energy(const ReportOptions& options) {
    const std::vector<std::string> stroke{"stroke=in-out", "hand.start_angstrom=7", "peak_nN=3",
                                          "stroke_s=3", "seconds=12"};
    std::vector<std::vector<std::string>> table{{"design", "friction", "T_s", "energy (mJ)",
                                                 "off the law (N rms)", "closest (Å)",
                                                 "in the end (Å)"}};
    std::vector<std::vector<double>> bars(periods_ms.size());
    for (const std::string_view friction : {"0", "0.26"})
        for (const std::string_view design : designs) {
            report_progress(fmt::format("mode {}, friction {} N", design, friction));
            for (std::size_t i = 0; i < periods_ms.size(); ++i) {
                std::vector<std::string> settings = stroke;
                settings.insert(settings.end(), {fmt::format("mode={}", design),
                                                 fmt::format("friction_N={}", friction),
                                                 fmt::format("period_ms={}", periods_ms[i])});
                const AxisRun p = play_axis({options.scene, settings_of(options, settings)});
                table.push_back(
                    {std::string(design), fmt::format("{} N", friction),
                     fmt::format("{} ms", periods_ms[i]), fmt::format("{:+.2f}", p.energy_J * 1e3),
                     fmt::format("{:.3f}", p.error_N), fmt::format("{:.2f}", p.closest_angstrom),
                     fmt::format("{:.2f}", p.last_angstrom)});
                if (friction == "0") bars[i].push_back(p.energy_J * 1e3);
            }
        }
    for (std::size_t i = 0; i < bars.size(); ++i)
        bars[i].insert(bars[i].begin(), static_cast<double>(i));

    ReportSection section{"energy", "Energy by design and period"};
    section.shows =
        "Work on a medium hand over a stroke of 3 s to 3 nN and 3 s back, + given to it: modes 1 "
        "and 2 as printed, and guarded coupling. Off the law: the rendered force without servo "
        "damping, minus the force of the ideal law for the molecule at rest at the same place.";
    section.body = draw_figure(format_data("energy", bars) + R"(set style data histograms
set style fill solid 0.85
set xzeroaxis lt -1
set xtics ('1' 0, '5' 1, '14' 2, '83' 3)
set xlabel 'T_s (ms)'
set ylabel 'energy (mJ)'
set key outside right
plot $energy using 2 lc rgb '#c0392b' title 'mode 1', '' using 3 lc rgb '#1f5fa8' title 'mode 2', \
     '' using 4 lc rgb '#1e8449' title 'guarded'
)",
                               "Without friction.", {900, 340}) +
                   format_table(table);
    section.differs =
        "The paper gives no energies. If the molecule does not return to 7 Å, the path is not "
        "closed and the number includes potential energy of the field.";
    std::vector<std::string> settings = stroke;
    settings.insert(settings.end(), {"mode=2", "friction_N=0", "period_ms=14"});
    section.command = run_command_of(options, settings);
    return section;
}

}  // namespace palpa
