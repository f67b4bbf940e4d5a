// The limits that guarded coupling is held to on two waters, and what this run measured.
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/probe.h"
#include "tools/lab/experiments/axis_run.h"
#include "tools/lab/report/criteria.h"
#include "tools/lab/report/sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace palpa {
namespace {

using Row = CriterionRow;

constexpr std::array<std::string_view, 5> holding{"light", "slack", "medium", "firm", "firm-grip"};

// Hands, periods and frictions of the limits; where time is short, those that shake soonest.
struct Conditions {
    std::vector<std::string_view> hands{"none", "light", "slack", "medium", "firm", "firm-grip"};
    std::vector<std::string_view> hands_that_move{holding.begin(), holding.end()};
    std::vector<int> periods_ms{1, 5, 14, 83};
    std::vector<double> frictions_newton{0.0, 0.26};

    explicit Conditions(bool is_quick) {
        if (!is_quick) return;
        hands_that_move = {"light", "medium", "firm"};
        periods_ms = {1, 83};
    }
};

// The largest of what runs under all hands, periods and frictions come to.
struct Worst {
    double ripple_N = 0, off_angstrom = 0, energy_J = -1e9, error_N = 0, attraction_N = 1e9;
    double closest_angstrom = 1e9, largest_nN = 0;
    int at_clamp = 0;
    std::size_t runs = 0;
    SafetyStage stage = SafetyStage::None;

    void add(const AxisRun& p, double rest) {
        ripple_N = std::max(ripple_N, p.ripple_N);
        off_angstrom = std::max(off_angstrom, std::abs(p.last_angstrom - rest));
        energy_J = std::max(energy_J, p.energy_J);
        error_N = std::max(error_N, p.error_N);
        attraction_N = std::min(attraction_N, p.attraction_N);
        closest_angstrom = std::min(closest_angstrom, p.closest_angstrom);
        largest_nN = std::max(largest_nN, p.largest_nN);
        at_clamp += p.at_clamp;
        stage = std::max(stage, p.stage);
        ++runs;
    }

    void add(const Worst& w) {
        ripple_N = std::max(ripple_N, w.ripple_N);
        off_angstrom = std::max(off_angstrom, w.off_angstrom);
        energy_J = std::max(energy_J, w.energy_J);
        error_N = std::max(error_N, w.error_N);
        attraction_N = std::min(attraction_N, w.attraction_N);
        closest_angstrom = std::min(closest_angstrom, w.closest_angstrom);
        largest_nN = std::max(largest_nN, w.largest_nN);
        at_clamp += w.at_clamp;
        stage = std::max(stage, w.stage);
        runs += w.runs;
    }
};

template <class Adjust>
Worst play_all(const ReportOptions& options, const std::vector<std::string_view>& hands,
               const std::vector<std::string>& settings, double rest, const Adjust& adjust) {
    const Conditions conditions(options.quick);
    Worst worst;
    for (const std::string_view hand : hands)
        for (const int period_ms : conditions.periods_ms)
            for (const double friction : conditions.frictions_newton) {
                std::vector<std::string> all = settings;
                all.insert(all.end(), {"mode=guarded", fmt::format("hand.grip={}", hand),
                                       fmt::format("period_ms={}", period_ms),
                                       fmt::format("friction_N={}", friction)});
                AxisCase c{options.scene, settings_of(options, all)};
                adjust(c);
                worst.add(play_axis(c), rest);
            }
    return worst;
}

Worst play_all(const ReportOptions& options, const std::vector<std::string_view>& hands,
               const std::vector<std::string>& settings, double rest) {
    return play_all(options, hands, settings, rest, [](AxisCase&) {});
}

void add_holds(const ReportOptions& options, double rest, std::vector<Row>& rows) {
    const Conditions conditions(options.quick);
    const std::vector<std::string> held{"stroke=hold", "kick_N_s=0.005", "seconds=6",
                                        fmt::format("hand.start_angstrom={:.4f}", rest)};
    const auto add = [&](const char* name, const Worst& worst) {
        rows.push_back({fmt::format("{} ({} runs)", name, worst.runs),
                        "ripple &lt; 0.02 N, off by &lt; 0.3 Å",
                        fmt::format("{:.4f} N, {:.3f} Å", worst.ripple_N, worst.off_angstrom),
                        worst.ripple_N < 0.02 && worst.off_angstrom < 0.3 &&
                            worst.stage <= SafetyStage::Slewed});
    };
    add("Held at rest and knocked", play_all(options, conditions.hands, held, rest));
    std::vector<std::string> tenfold = held;
    tenfold.insert(tenfold.end(), {"coupling.A_f_max=51e9", "coupling.A_f_min=6.4e9"});
    add("The same, force gains tenfold",
        play_all(options, {"none", "light", "medium", "firm"}, tenfold, rest));
}

// A coupling in which nothing could shake would prove nothing.
void add_instability(const ReportOptions& options, double rest, std::vector<Row>& rows) {
    const AxisRun p = play_axis(
        {options.scene,
         settings_of(options, {"mode=2", "hand.grip=medium", "period_ms=14", "friction_N=0",
                               "servo_delay_ticks=1", "stroke=hold", "kick_N_s=0.005", "seconds=10",
                               fmt::format("hand.start_angstrom={:.4f}", rest)})});
    rows.push_back({"Mode 2 as printed, knocked at rest: shakes", "1.08 ± 0.1 N at 6.6 ± 0.4 Hz",
                    fmt::format("{:.2f} N at {:.1f} Hz", p.ripple_N, p.ripple_hertz),
                    std::abs(p.ripple_N - 1.08) <= 0.1 && std::abs(p.ripple_hertz - 6.6) <= 0.4});
}

// In by `depth_mm`, rest there, and out again.
std::vector<std::string> stroke_settings(double depth_mm, double stroke_s) {
    const double far = depth_mm / 2, in_s = 0.3 + stroke_s, out_s = in_s + 1;
    return {"stroke=path", "hand.start_angstrom=7",
            fmt::format("path=[[0.3, {0}], [{1}, {2}], [{3}, {2}], [{4}, {0}]]", far, in_s, -far,
                        out_s, out_s + stroke_s),
            fmt::format("seconds={}", out_s + stroke_s + 1)};
}

// How deep this hand's stroke goes to reach 3 nN at 1 ms without friction: a loose hand overshoots.
double depth_to_peak(const ReportOptions& options, std::string_view hand, double stroke_s) {
    double less = 80, more = 148;
    for (int halving = 0; halving < 7; ++halving) {
        const double depth = 0.5 * (less + more);
        std::vector<std::string> settings = stroke_settings(depth, stroke_s);
        settings.insert(settings.end(), {"mode=guarded", fmt::format("hand.grip={}", hand),
                                         "period_ms=1", "friction_N=0"});
        (play_axis({options.scene, settings_of(options, settings)}).largest_nN > 3 ? more : less) =
            depth;
    }
    return less;
}

void add_strokes(const ReportOptions& options, double rest, std::vector<Row>& rows) {
    const Conditions conditions(options.quick);
    for (const double stroke_s : {3.0, 1.0}) {
        Worst w;
        for (const std::string_view hand : conditions.hands_that_move) {
            const double depth_mm = depth_to_peak(options, hand, stroke_s);
            w.add(play_all(options, {hand}, stroke_settings(depth_mm, stroke_s), rest));
        }
        const auto name = fmt::format("Strokes to 3 nN in {} s ({} runs)", stroke_s, w.runs);
        const double error_bar = stroke_s < 2 ? 0.02 : 0.01;
        rows.push_back({name + ": energy given to the hand", "≤ +1 mJ",
                        fmt::format("{:+.2f} mJ", w.energy_J * 1e3), w.energy_J <= 1e-3});
        rows.push_back({name + ": error of the force", fmt::format("≤ {} N rms", error_bar),
                        fmt::format("{:.4f} N", w.error_N), w.error_N <= error_bar});
        rows.push_back({name + ": attraction felt", "≥ 0.85 N",
                        fmt::format("{:.3f} N", w.attraction_N), w.attraction_N >= 0.85});
        rows.push_back({name + ": truncation", "0 ticks at 3 N", fmt::format("{}", w.at_clamp),
                        w.at_clamp == 0 && w.stage <= SafetyStage::Slewed});
    }
}

void add_walls(const ReportOptions& options, double rest, std::vector<Row>& rows) {
    Worst fast, push;
    for (const double m_per_s : {0.03, 0.1, 0.3, 0.6}) {
        if (options.quick && m_per_s < 0.2) continue;
        const double way_s = 0.09 / m_per_s;
        const Worst w =
            play_all(options, {"firm"},
                     {"stroke=path", "hand.start_angstrom=10",
                      fmt::format("path=[[0.3, 45], [{0:.3f}, -45], [{1:.3f}, -45], [{2:.3f}, 45]]",
                                  0.3 + way_s, 0.8 + way_s, 0.8 + 2 * way_s),
                      fmt::format("seconds={:.3f}", 1.5 + 2 * way_s)},
                     rest);
        fast.add(w);
    }
    rows.push_back({fmt::format("Approach at up to 0.6 m/s ({} runs)", fast.runs),
                    "&gt; 2.6 Å, &lt; 1 nN",
                    fmt::format("{:.2f} Å, {:.2f} nN", fast.closest_angstrom, fast.largest_nN),
                    fast.closest_angstrom > 2.6 && fast.largest_nN < 1});
    for (const double way_s : {0.5, 2.0}) {
        // 9.5 cm lead to 3 nN; further out than this the hand would clutch.
        const Worst w = play_all(options, {"firm"},
                                 {"stroke=path", "hand.start_angstrom=7",
                                  fmt::format("path=[[0.3, 74], [{0}, -74], [{1}, -74], [{2}, 74]]",
                                              0.3 + way_s, 0.8 + way_s, 0.8 + 2 * way_s),
                                  fmt::format("seconds={}", 1.8 + 2 * way_s)},
                                 rest);
        push.add(w);
    }
    rows.push_back({fmt::format("Pushed 5 cm too far ({} runs)", push.runs),
                    "≥ 2.32 Å, ≤ 10 nN, energy ≤ 0",
                    fmt::format("{:.3f} Å, {:.2f} nN, {:+.1f} mJ", push.closest_angstrom,
                                push.largest_nN, push.energy_J * 1e3),
                    push.closest_angstrom >= 2.32 && push.largest_nN <= 10 && push.energy_J <= 0});
}

void add_drift(const ReportOptions& options, std::vector<Row>& rows) {
    const int cycles = options.quick ? 3 : 10;
    double most = 0;
    for (const double way_s : {2.0, 0.7}) {
        double time = 0.2;
        std::string path = fmt::format("path=[[{}, 50]", time);
        for (int i = 0; i < cycles; ++i) {
            path += fmt::format(", [{:.2f}, -50], [{:.2f}, 50]", time + way_s, time + 2 * way_s);
            time += 2 * way_s;
        }
        const auto stiff = [](AxisCase& c) {
            c.hand = HandModel{0.3, 500, 2e4};  // hardly moves
            c.cools = true;
        };
        const Worst w = play_all(options, {"firm"},
                                 {"stroke=path", "hand.start_angstrom=7", path + "]",
                                  fmt::format("seconds={:.2f}", time + 0.5)},
                                 7, stiff);
        most = std::max(most, w.off_angstrom / cycles);
    }
    rows.push_back({fmt::format("Drift over {} strokes in and out, each", cycles), "≤ 0.1 Å",
                    fmt::format("{:.3f} Å", most), most <= 0.1});
}

}  // namespace

ReportSection report_acceptance(const ReportOptions& options) {
    const SceneDescription scene = read_scene(options.scene, options.settings);
    const World world = load_world(scene);
    const double rest = equilibrium_distance(world).value_or(0);
    std::vector<Row> rows;
    add_dimer_limits(world, rest, rows);
    add_law_limits(rows);
    report_progress("holds");
    add_instability(options, rest, rows);
    add_holds(options, rest, rows);
    report_progress("strokes");
    add_strokes(options, rest, rows);
    report_progress("walls");
    add_walls(options, rest, rows);
    add_drift(options, rows);
    report_progress("random scenarios and closed paths");
    add_random_limits(options, rows);

    ReportSection section{"acceptance", "Acceptance: limit and measured value"};
    section.shows =
        "The limits for guarded coupling and the worst value of this run: hands from none to "
        "firm-grip, with and without the device's friction of 0.26 N, periods from 1 to 83 ms.";
    std::vector<std::vector<std::string>> table{{"test", "limit", "measured", ""}};
    for (const Row& row : rows) {
        table.push_back({row.test, row.limit, row.measured,
                         row.is_met ? "met" : "<span class=\"missed\">missed</span>"});
        section.meets_limits = section.meets_limits && row.is_met;
    }
    section.body = format_table(table);
    section.differs = "The paper has no such limits.";
    section.command = fmt::format(
        "ctest --preset release -R guarded; palpa-lab scenarios {0} --count {1} --seed {3}; palpa "
        "closed-paths "
        "{0}/space.toml --count {2} --seed {3}",
        options.scene.string(), options.quick ? 20 : 500, options.quick ? 20 : 300, options.seed);
    return section;
}

}  // namespace palpa
