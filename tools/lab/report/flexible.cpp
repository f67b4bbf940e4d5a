// Figure 9, an inhibitor drawn out of a compliant protease, and what few active joints cost
// and save there.
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/mechanics.h"
#include "tools/lab/bench/stroke.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace palpa {
namespace {

// Along x, the line of the pull: time, force on the molecule (nN), force on the hand (N), how far
// it went (Å), A_d; every 50th tick.
struct Pull {
    std::vector<std::vector<double>> rows;
    Summary summary;
    std::size_t joints = 0;
    double period_ms = 0;
};

Pull play_pull(const std::filesystem::path& file) {
    constexpr std::uint64_t every = 50;
    const SceneDescription scene = read_scene(file);
    World world = load_world(scene);
    EmulatedOmni omni(build_emulated_omni(scene, world));
    Pull pull;
    pull.period_ms = scene.period_ms;
    std::optional<double> start;
    std::uint64_t tick_number = 0;
    pull.summary =
        run_headless(scene, world, omni, {}, nullptr, {}, {}, [&](const ServoTick& tick) {
            if (tick_number++ % every != 0) return;
            const ContactModel& contact = tick.contact;
            const double x = contact.molecule.place_angstrom.x();
            if (!start) start = x;
            pull.rows.push_back({tick.reading.time_s, contact.force_newton.x() * 1e9,
                                 tick.sent_newton.x(), x - *start,
                                 contact.displacement_gain / 1e9});
        });
    pull.joints = world.resource<StartReport>().joints;
    return pull;
}

std::string describe(const std::string& name, const Pull& pull) {
    const Summary& s = pull.summary;
    const std::string active =
        s.activity ? fmt::format("{:.0f} degrees of freedom active", s.activity->active)
                   : fmt::format("all {} joints active", pull.joints);
    return fmt::format(
        "{}: {}, T_s = {} ms; {:.1f} Å out, {:.2f} Å from its start in the end, {:+.0f} mJ given "
        "to "
        "the hand, ripple {:.3f} N, a step takes {:.1f} ms.",
        name, active, pull.period_ms, s.unbinding ? s.unbinding->farthest : 0.0,
        s.unbinding ? s.unbinding->last_rmsd : 0.0, s.net_work_J * 1e3,
        s.ripple ? s.ripple->rms : 0.0, s.step_median_us * 1e-3);
}

constexpr const char* both_panels = R"(set multiplot layout 1,2
set xzeroaxis lt -1
set ytics nomirror
set y2tics
unset key
set xlabel 'time (s)'
set yrange [-12:12]
set ylabel 'force on the molecule F_m (nN)' tc rgb '#c0392b'
set y2label 'force on the hand F_h (N)' tc rgb '#1f5fa8'
set y2range [-3:3]
plot $pull using 1:2 with lines lc rgb '#c0392b', \
     $pull using 1:3 axes x1y2 with lines lc rgb '#1f5fa8'
set autoscale y
set autoscale y2
set y2range [0:*]
set ylabel 'position (Å)' tc rgb '#555555'
set y2label 'A_d (10^9)' tc rgb '#1e8449'
plot $pull using 1:5 axes x1y2 with lines lc rgb '#1e8449', \
     $pull using 1:4 with lines lw 2 lc rgb '#555555'
unset multiplot
)";

// Of a path with few active joints: how far its forces are from those of the exact one, as a share.
double relative_error(const std::vector<Vec3>& forces, const std::vector<Vec3>& exact) {
    double off = 0, all = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        off += (forces[i] - exact[i]).squaredNorm();
        all += exact[i].squaredNorm();
    }
    return std::sqrt(off / all);
}

}  // namespace

ReportSection report_figure_9(const ReportOptions& options) {
    const std::filesystem::path paper = options.flexible.parent_path() / "paper.toml";
    ReportSection section{"figure-9", "Figure 9: extraction and reinsertion of an HIV inhibitor"};
    section.shows =
        "Haptic and molecular force along the tunnel, and position of the inhibitor with A_d, over "
        "time, while it is led out and back; forces beyond 12 nN are cut off.";
    section.command = fmt::format("palpa run {} --headless", options.flexible.string());
    if (std::filesystem::exists(paper)) {
        report_progress("in the paper's terms");
        const Pull few = play_pull(paper);
        double largest_nN = 0;
        for (const std::vector<double>& row : few.rows)
            largest_nN = std::max(largest_nN, std::abs(row[1]));
        section.body += draw_figure(format_data("pull", few.rows) + both_panels,
                                    describe("In the paper's terms, mode 1", few));
        const UnbindingPath unbinding = few.summary.unbinding.value_or(UnbindingPath{});
        section.differs = fmt::format(
            "In the paper the inhibitor is that of 2AZ8, a person leads it, and it leaves the "
            "protease. In the paper's terms here (mode 1, 40 degrees of freedom chosen by regions "
            "and accelerations, T_s = 83 ms; engine/paper.md) TL-3 does not: a force of up to "
            "{:.3g} "
            "nN opposes it, it moves {:.1f} Å within {:.0f} s, and its nearest protein heavy atom "
            "there is {:.1f} Å away. ",
            largest_nN, unbinding.farthest, few.rows.empty() ? 0.0 : few.rows.back()[0],
            unbinding.clearance);
        section.command =
            fmt::format("palpa run {} --headless; {}", paper.string(), section.command);
    }
    if (!options.quick) {
        report_progress("Palpa's best");
        const Pull all = play_pull(options.flexible);
        section.body += draw_figure(format_data("pull", all.rows) + both_panels,
                                    describe("Palpa's best, guarded, second order", all));
        section.differs += "Palpa's best moves everything, and its gains are the scene's.";
    }
    return section;
}

ReportSection report_speed(const ReportOptions& options) {
    const int moves = options.quick ? 20 : 200;
    const SceneDescription scene = read_scene(options.flexible);
    const Connectivity connectivity = load_system(scene).connectivity;
    const BenchStart start = load_start(scene, connectivity);
    const TorsionState& rest = start.world.resource<TorsionState>();
    World exact =
        build_variant(start, {everything, {}, JointWeights::Acceleration, PairPrecision::Double});
    put(rest, exact);
    report_progress("all joints, pairs in double");
    const std::vector<Vec3> forces = play_stroke(start, moves, exact).forces;
    std::vector<std::vector<std::string>> table{
        {"active joints", "mean step (µs)", "of all joints'", "error of the force"}};
    std::string points = "$points << EOD\n";
    const std::vector<std::size_t> counts =
        options.quick ? std::vector<std::size_t>{everything, 40}
                      : std::vector<std::size_t>{everything, 320, 160, 80, 40, 20, 10};
    double all_us = 0;
    for (const std::size_t active : counts) {
        const std::string name = active == everything ? "all" : fmt::format("{}", active);
        report_progress(name + " active");
        World world =
            build_variant(start, {active, {}, JointWeights::HandProximity, PairPrecision::Fast});
        const StrokeResult stroke = time_stroke(start, rest, moves, world);
        if (active == everything) all_us = stroke.mean_us();
        const double error = relative_error(stroke.forces, forces);
        table.push_back({name, fmt::format("{:.0f}", stroke.mean_us()),
                         fmt::format("{:.3f}", stroke.mean_us() / all_us),
                         fmt::format("{:.3g} %", 100 * error)});
        points += fmt::format("{} {} \"{}\"\n", stroke.mean_us() * 1e-3, 100 * error, name);
    }
    ReportSection section{"speed", "Speed against error of few active joints"};
    section.shows = fmt::format(
        "The hand moves {:.2f} Å along the tunnel and back in {} moves. The plot shows the time of "
        "a step and the error of the force on the hand against all joints active and all pairs in "
        "double precision.",
        0.005 * moves / 2, moves);
    section.body = draw_figure(points + R"(EOD
set logscale xy
set xlabel 'mean step (ms)'
set ylabel 'error of the force (%)'
set offsets graph 0.1, graph 0.1, graph 0.15, 0
unset key
plot $points using 1:2 with points pt 7 ps 0.8 lc rgb '#1f5fa8', \
     '' using 1:2:3 with labels offset 0,0.8
)",
                               "Beside each point: active joints.", {700, 360}) +
                   format_table(table);
    section.differs =
        "In the paper a step with 40 of 848 active takes 83 ms, on a processor of 3 GHz; it gives "
        "no "
        "error.";
    section.command =
        fmt::format("palpa-lab bench {} --adaptive --table", options.flexible.string());
    return section;
}

}  // namespace palpa
