#include "tools/loops.h"

#include "core/draws.h"
#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "scene/read_scene.h"
#include "session/continuous_law.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "tools/hands.h"
#include "tools/scenarios.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace palpa {
namespace {

// A polygon of three to five corners within the box that a clutch is not needed in, and back to
// where it began; a rest at the end.
std::vector<std::string> draw_settings(Draws& draws, bool turn, bool& in_plane) {
    constexpr double lead_s = 0.3, rest_s = 8, most_degrees = 120;
    const Vec3 box_mm(60, 45, 25);
    std::vector<std::string> settings = draw_hand(draws);
    in_plane = draws.below(2) == 0;
    settings.push_back(fmt::format("hand.start_offset_angstrom=[{:.4f}, {:.4f}, {:.4f}]",
                                   draws.between(-0.1, 2.5), draws.between(-0.5, 0.5),
                                   in_plane ? 0 : draws.between(-0.5, 0.5)));
    const double mm_per_s = draws.scale(15, 150);
    const auto draw_within = [&](const Vec3& most) {
        Vec3 place;
        for (double& x : place) x = draws.between(-1, 1);
        return Vec3(place.cwiseProduct(most));
    };
    const std::size_t corners = 3 + draws.below(3);
    std::vector<std::string> points;
    double time_s = lead_s;
    Vec3 place = Vec3::Zero();
    const auto go_to = [&](const Vec3& next, const Vec3& degrees) {
        time_s += std::max(0.3, (next - place).norm() / mm_per_s);
        place = next;
        points.push_back(fmt::format("[{:.4f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f}]",
                                     time_s, next.x(), next.y(), next.z(), degrees.x(), degrees.y(),
                                     degrees.z()));
    };
    points.push_back(fmt::format("[{:.4f}, 0, 0, 0]", time_s));
    for (std::size_t i = 0; i < corners; ++i) {
        Vec3 next = draw_within(box_mm);
        if (in_plane) next.z() = 0;
        go_to(next, turn ? draw_within(Vec3::Constant(most_degrees)) : Vec3(Vec3::Zero()));
    }
    go_to(Vec3::Zero(), Vec3::Zero());
    settings.push_back(fmt::format("hand.path=[{}]", fmt::join(points, ", ")));
    settings.push_back(fmt::format("run.seconds={:.3f}", time_s + rest_s));
    return settings;
}

// Each force is of all pairs in double, some thousands of times a loop.
void warn_of_cost(const LoopOptions& options) {
    constexpr double pair_s = 1.9e-4, most_s = 600;  // a pair in a loop, on scenes/hiv
    const Simulation simulation = load_simulation(read_scene(options.scene, options.settings));
    const std::size_t held = grabbed_points(simulation).positions.size();
    const auto pairs = static_cast<double>(held * (simulation.atoms.positions.size() - held));
    const double all_s = pair_s * pairs * static_cast<double>(options.count);
    if (all_s < most_s) return;
    fmt::print(stderr,
               "warning: {:.0f} pairs of atoms: a loop takes about {:.2g} s, all {:.2g} h\n", pairs,
               pair_s * pairs, all_s / 3600);
}

// Takes every tick of a loop.
class LoopWatch {
public:
    LoopWatch(const SceneDescription& scene, const Simulation& simulation, const Vec3& workspace)
        : servo_(build_servo_settings(scene, simulation, workspace)),
          cap_N_per_m_(servo_.guarded.value_or(GuardedSettings{}).cap_N_per_m),
          law_(servo_.guarded.value_or(GuardedSettings{}), load_simulation(scene)),
          start_(law_.pose().place_angstrom),
          under_way_(static_cast<std::size_t>(servo_.delay_ticks) + 1, Vec3::Zero()) {}

    void add(const ServoTick& tick) {
        const DeviceReading& reading = tick.reading;
        HandleStep step;
        if (before_) {
            step = {reading.position_m - before_->position_m,
                    reading.orientation * before_->orientation.conjugate()};
        } else {
            first_ = reading;
        }
        before_ = reading;
        // Warm motors played this share of the force, and the molecule took it of the way.
        step.moved_m *= tick.followed;
        // The force of the tick before did this, with a damping that was so much older.
        damped_J_ += under_way_[tick_ % under_way_.size()].dot(step.moved_m);
        under_way_[tick_ % under_way_.size()] = tick.damping_newton;
        if (!tick.clutched) law_.follow(step);
        result_.work_J = tick.hand_energy_J - damped_J_;
        result_.was_limited =
            result_.was_limited || !tick.kept_m.isZero() || tick.stage == SafetyStage::Hot;
        result_.dropped_mm += 1e3 * tick.dropped_m.norm();
        result_.largest_N = std::max(result_.largest_N, tick.sent_newton.norm());
        result_.was_held_back = result_.was_held_back || tick.stage > SafetyStage::Hot;
        constexpr std::uint64_t seldom = 10;
        if (tick_ % seldom == 0) {
            result_.felt_share = std::max(
                result_.felt_share,
                law_.felt_stiffness(tick.touch.molecule, tick.molecule_per_handle) / cap_N_per_m_);
        }
        last_ = tick.touch.molecule;
        ++tick_;
    }

    // At the end: friction and forces have held the handle somewhere near to where it began, and
    // the law is brought home from there, straight.
    LoopResult take() {
        LoopResult result = result_;
        const Vec3 end = law_.pose().place_angstrom;
        result.law_J = law_.work_joule();
        result.drift_angstrom = (last_.place_angstrom - end).norm();
        result.farthest_angstrom = law_.farthest_angstrom();
        if (!before_) return result;
        const HandleStep home{first_.position_m - before_->position_m,
                              first_.orientation * before_->orientation.conjugate()};
        result.open_mm = 1e3 * home.moved_m.norm();
        law_.follow(home);
        result.closed_law_J = law_.work_joule();
        result.closure_angstrom = (law_.pose().place_angstrom - start_).norm();
        return result;
    }

private:
    ServoSettings servo_;
    double cap_N_per_m_;
    ContinuousLaw law_;
    Vec3 start_;
    std::vector<Vec3> under_way_;  // damping of the last ticks, N
    DeviceReading first_;
    std::optional<DeviceReading> before_;
    MoleculePose last_;
    double damped_J_ = 0;
    std::uint64_t tick_ = 0;
    LoopResult result_;
};

nlohmann::ordered_json as_json(std::size_t number, const LoopResult& r) {
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
            {"dropped_mm", r.dropped_mm},
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

// A row of the table: of which loops, what of them.
struct Row {
    const char* what;
    double scale;
    std::string bar;
    bool (*counts)(const LoopResult&);
    double (*value)(const LoopResult&);
};

void print_table(const std::vector<LoopResult>& all, bool turned) {
    const auto free = [](const LoopResult& r) { return !r.was_limited; };
    const auto near = [](const LoopResult& r) {
        return !r.was_limited && r.farthest_angstrom <= near_angstrom;
    };
    const auto any = [](const LoopResult&) { return true; };
    const std::string energy_bar = turned ? "" : fmt::format("{}", 1e3 * most_extra_J);
    const std::array rows = std::to_array<Row>({
        {"work beyond the continuous law's, in the plane, mJ", 1e3, energy_bar,
         [](const LoopResult& r) { return !r.was_limited && r.in_plane; },
         [](const LoopResult& r) { return std::abs(r.extra_joule()); }},
        {"the same in space, mJ", 1e3, energy_bar,
         [](const LoopResult& r) { return !r.was_limited && !r.in_plane; },
         [](const LoopResult& r) { return std::abs(r.extra_joule()); }},
        {"generated, at the stop or with warm motors, mJ", 1e3, energy_bar,
         [](const LoopResult& r) { return r.was_limited; },
         [](const LoopResult& r) { return r.extra_joule(); }},
        {"work of the continuous law, brought home, mJ", 1e3, "", free,
         [](const LoopResult& r) { return std::abs(r.closed_law_J); }},
        {"drift beyond the continuous law's, inside of 6 Å, Å", 1,
         turned ? "" : fmt::format("{}", most_drift_angstrom), near,
         [](const LoopResult& r) { return r.drift_angstrom; }},
        {"the same outside, Å", 1, "",
         [](const LoopResult& r) { return !r.was_limited && r.farthest_angstrom > near_angstrom; },
         [](const LoopResult& r) { return r.drift_angstrom; }},
        {"from begin to end by the continuous law, brought home, Å", 1, "", near,
         [](const LoopResult& r) { return r.closure_angstrom; }},
        {"ripple at rest, N", 1, fmt::format("{}", most_loop_ripple_N), any,
         [](const LoopResult& r) { return r.ripple_N; }},
        {"stiffest felt, of the cap", 1, fmt::format("{}", most_felt_share), any,
         [](const LoopResult& r) { return r.felt_share; }},
        {"largest force felt, N", 1, "", any, [](const LoopResult& r) { return r.largest_N; }},
    });
    fmt::print(
        "| what | loops | median | 90 % | most | bar |\n| --- | --- | --- | --- | --- | --- |\n");
    for (const Row& row : rows) {
        std::vector<double> values;
        for (const LoopResult& result : all)
            if (row.counts(result)) values.push_back(row.scale * row.value(result));
        fmt::print("| {} | {} | {} | {} |\n", row.what, values.size(), format_spread(values),
                   row.bar);
    }
}

}  // namespace

bool meets_bars(const LoopResult& r, bool turned) noexcept {
    // Beyond these limits there is no continuous law but that nothing is generated.
    const double extra = r.was_limited ? r.extra_joule() : std::abs(r.extra_joule());
    const bool keeps_energy = turned || extra <= most_extra_J;
    const bool stays = turned || r.was_limited || r.farthest_angstrom > near_angstrom ||
                       r.drift_angstrom <= most_drift_angstrom;
    return keeps_energy && stays && r.ripple_N <= most_loop_ripple_N &&
           r.felt_share <= most_felt_share && !r.was_held_back;
}

void check_loops(const LoopOptions& options) {
    for (const std::string& setting : options.settings) {
        const std::string key(trimmed(setting.substr(0, setting.find('='))));
        for (const std::string own : {"hand.stroke", "hand.path", "run.seconds"}) {
            if (key != own && !own.ends_with("." + key)) continue;
            throw LoadError({"--set " + setting},
                            "every loop has a way and a length of its own; expected no " + own);
        }
    }
    const SceneDescription scene = read_scene(options.scene, options.settings);
    if (scene.coupling.mode != CouplingMode::Guarded) {
        throw LoadError(scene.place_of("coupling.mode"),
                        "the continuous law is guarded coupling's; expected coupling.mode = "
                        "\"guarded\"");
    }
    for (const MoleculeDescription& molecule : scene.molecules) {
        if (molecule.name != scene.grab.molecule) continue;
        const bool turns = molecule.motion == Motion::WithHandle;
        if (options.turn && !turns) {
            throw LoadError(scene.place_of("grab.molecule"),
                            "does not turn with the handle; expected a molecule whose motion is "
                            "with-handle, or no --turn");
        }
        if (!scene.has_statics() && (turns || molecule.motion == Motion::Translate)) continue;
        throw LoadError(scene.place_of("grab.molecule"),
                        "expected a rigid molecule that moves in space, translate or with-handle, "
                        "and no other that moves by itself");
    }
}

LoopResult play_loop(const LoopOptions& options, std::size_t number) {
    Draws draws(options.seed, number);
    bool in_plane = false;
    std::vector<std::string> settings = draw_settings(draws, options.turn, in_plane);
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    const SceneDescription scene = read_scene(options.scene, settings);
    Simulation simulation = load_simulation(scene);
    EmulatedOmni device(build_emulated_omni(scene, simulation));
    LoopWatch watch(scene, simulation, device.spec().half_workspace_m);
    const Summary summary = run_headless(scene, simulation, device, {}, nullptr, {}, {},
                                         [&](const ServoTick& tick) { watch.add(tick); });
    LoopResult result = watch.take();
    result.settings = settings;
    result.in_plane = in_plane;
    result.period_ms = scene.period_ms;
    result.clamped_share = summary.clamped_share;
    result.ripple_N = summary.ripple ? summary.ripple->rms : 0;
    return result;
}

std::vector<LoopResult> play_loops(
    const LoopOptions& options,
    const std::function<void(std::size_t number, const LoopResult&)>& on_result) {
    std::vector<LoopResult> results;
    for (std::size_t i = options.first; i < options.first + options.count; ++i) {
        results.push_back(play_loop(options, i));
        if (on_result) on_result(i, results.back());
    }
    return results;
}

int loops_command(const LoopOptions& options) {
    check_loops(options);
    warn_of_cost(options);
    const bool is_watched = isatty(STDERR_FILENO) != 0;
    const std::size_t last = options.first + options.count;
    const std::vector<LoopResult> results = play_loops(options, [&](std::size_t number,
                                                                    const LoopResult& r) {
        if (is_watched && number % 20 == 0) fmt::print(stderr, "\r{} of {} ", number, last);
        if (meets_bars(r, options.turn) || options.json) return;
        fmt::print(
            "loop {}: {:+.5f} J of work, the law's {:+.5f}; drift {:.3f} Å, out to {:.2f} Å; "
            "ripple {:.3f} N; felt {:.2f} of the cap{}\n  palpa run --headless {} --set \"{}\"\n",
            number, r.work_J, r.law_J, r.drift_angstrom, r.farthest_angstrom, r.ripple_N,
            r.felt_share, r.was_held_back ? ", held back by the safety chain" : "",
            options.scene.string(), fmt::join(r.settings, "\" --set \""));
    });
    if (is_watched) fmt::print(stderr, "\r{:30}\r", "");
    const auto failed = static_cast<std::size_t>(std::ranges::count_if(
        results, [&](const LoopResult& r) { return !meets_bars(r, options.turn); }));
    if (options.json) {
        nlohmann::ordered_json report{
            {"count", results.size()}, {"seed", options.seed}, {"failed", failed}};
        for (std::size_t i = 0; i < results.size(); ++i)
            report["loops"].push_back(as_json(options.first + i, results[i]));
        fmt::print("{}\n", report.dump(2));
    } else {
        fmt::print("{} loops, {} missed a bar\n\n", results.size(), failed);
        print_table(results, options.turn);
    }
    return failed == 0 ? 0 : 1;
}

}  // namespace palpa
