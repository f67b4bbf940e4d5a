#include "tools/journey.h"

#include "core/draws.h"
#include "core/load_error.h"
#include "devices/emulated_omni.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/simulation.h"
#include "tools/hands.h"
#include "tools/scenarios.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

namespace palpa {
namespace {

constexpr double most_ripple_newton = 0.02;

// Takes every tick of a run.
class JourneyWatch {
public:
    JourneyWatch(const ServoSettings& servo, const Simulation& simulation)
        : servo_(servo),
          simulation_(simulation),
          damping_(static_cast<std::size_t>(servo.delay_ticks) + 1, Vec3::Zero()) {}

    void add(const ServoTick& tick) {
        const Vec3& handle_m = tick.reading.position_m;
        compare();
        played_J_ += felt_newton_.dot(handle_m - handle_m_);
        handle_m_ = handle_m;
        const Vec3& place = tick.touch.molecule.place_angstrom;
        const double now_s = static_cast<double>(ticks_) * servo_tick_s;
        if (ticks_ == 0) start_ = place;
        const double away = (place - start_).norm();
        if (!result_.out_s && away >= 10) result_.out_s = now_s;
        if (result_.out_s && !result_.back_s && away <= 0.3) result_.back_s = now_s;
        if (tick.clutched && !was_clutched_) ++result_.clutches;
        was_clutched_ = tick.clutched;
        since_clutch_ = tick.clutched ? 0 : since_clutch_ + 1;
        is_limited_ = is_limited_ || !tick.kept_m.isZero() || tick.stage == SafetyStage::Hot;
        if (tick.clamped && tick.touch.force_newton.norm() <= 3e-9) ++cut_ticks_;
        // What leaves in this tick has a damping that is so much older.
        damping_[ticks_ % damping_.size()] = tick.damping_newton;
        ++ticks_;
        pose_s_ = tick.reading.time_s;
        felt_newton_ = tick.sent_newton - damping_[ticks_ % damping_.size()];
    }

    // It is back, and has been held at rest for longer than ripple is measured.
    bool is_over() const noexcept {
        constexpr double rest_s = 5;
        const double now_s = static_cast<double>(ticks_) * servo_tick_s;
        const double held_s = static_cast<double>(since_clutch_) * servo_tick_s;
        return result_.back_s && now_s > *result_.back_s + rest_s && held_s > rest_s;
    }

    JourneyResult result() const {
        JourneyResult result = result_;
        if (compared_ > 0) result.error_N = std::sqrt(squares_ / static_cast<double>(compared_));
        result.cut_share =
            static_cast<double>(cut_ticks_) / std::max(1.0, static_cast<double>(ticks_));
        return result;
    }

private:
    // The simulation has just answered the pose of the tick before, if it is its turn.
    void compare() {
        const TouchModel& answer = simulation_.touch.model;
        constexpr std::uint64_t in_hold = 250;  // ticks after which a force is felt in full again
        if (since_clutch_ < in_hold) answered_.reset();
        if (since_clutch_ < in_hold || answer.time_s != pose_s_) return;
        const ForceLaw& law = servo_.guarded ? servo_.guarded->force_law : servo_.force_law;
        Vec3 ideal = hand_force(law, answer.force_newton);
        ideal *= std::min(1.0, servo_.safety.clamp_newton / std::max(ideal.norm(), 1e-9));
        squares_ += (felt_newton_ - ideal).squaredNorm();
        ++compared_;
        if (answered_) {
            const Vec3 way = handle_m_ - answered_->handle_m;
            (is_limited_ ? result_.off_at_limits_J : result_.off_J) +=
                played_J_ - answered_->played_J - 0.5 * (ideal + answered_->ideal_newton).dot(way);
        }
        is_limited_ = false;
        answered_ = Answered{handle_m_, ideal, played_J_};
    }

    // Where the simulation gave its last answer.
    struct Answered {
        Vec3 handle_m, ideal_newton;
        double played_J;
    };

    const ServoSettings servo_;
    const Simulation& simulation_;
    JourneyResult result_;
    std::vector<Vec3> damping_;
    Vec3 start_ = Vec3::Zero(), felt_newton_ = Vec3::Zero();
    Vec3 handle_m_ = Vec3::Zero();
    std::optional<Answered> answered_;
    double pose_s_ = -1, squares_ = 0, played_J_ = 0;
    std::uint64_t ticks_ = 0, compared_ = 0, cut_ticks_ = 0, since_clutch_ = 0;
    bool was_clutched_ = false, is_limited_ = false;
};

SceneDescription read_journey(const JourneyOptions& options, std::vector<std::string>& settings) {
    settings.emplace_back("run.seconds=200");  // it ends sooner where it succeeds
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    SceneDescription scene = read_scene(options.scene, settings);
    if (!scene.has_statics()) {
        throw LoadError({scene.file.string()},
                        "nothing moves by itself here, so nothing leaves its pocket; expected a "
                        "flexible scene, as scenes/hiv/flexible.toml");
    }
    return scene;
}

JourneyResult play(const JourneyOptions& options, std::vector<std::string> settings) {
    const SceneDescription scene = read_journey(options, settings);
    Simulation simulation = load_simulation(scene);
    EmulatedOmni device(build_emulated_omni(scene, simulation));
    JourneyWatch watch(build_servo_settings(scene, simulation, device.spec().half_workspace_m),
                       simulation);
    const auto begin = std::chrono::steady_clock::now();
    const Summary summary = run_headless(
        scene, simulation, device, {}, nullptr, {}, {},
        [&](const ServoTick& tick) { watch.add(tick); }, [&] { return watch.is_over(); });
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    JourneyResult result = watch.result();
    result.settings = settings;
    if (watch.is_over() && summary.ripple) result.ripple_N = summary.ripple->rms;
    result.grip = hand_names[scene.hand.grip];
    result.mode = coupling_mode_names[static_cast<std::size_t>(scene.coupling.mode)];
    result.period_ms = scene.period_ms;
    result.active = scene.statics.active;
    result.summary = summary;
    result.wall_s = took.count();
    return result;
}

// The shortest period that 99 % of steps keep on this machine now, over 10 s of the stroke, ms.
double find_fastest_period(JourneyOptions options, std::int64_t active) {
    options.settings.push_back(fmt::format("statics.active={}", active));
    options.settings.insert(options.settings.end(), {"run.period_ms=10", "run.seconds=10"});
    return std::ceil(1e-3 * play(options, {}).summary.step_p99_us);
}

std::vector<std::vector<std::string>> list_choices(const JourneyOptions& options) {
    std::vector<std::vector<std::string>> all;
    for (const std::int64_t active : options.active) {
        std::vector<double> periods_ms = options.periods_ms;
        if (options.fastest) periods_ms.push_back(find_fastest_period(options, active));
        for (const double period_ms : periods_ms)
            for (const std::string& grip : options.grips)
                for (const std::string& mode : options.modes)
                    all.push_back({fmt::format("statics.active={}", active),
                                   fmt::format("run.period_ms={}", period_ms), "hand.grip=" + grip,
                                   "coupling.mode=" + mode});
    }
    return all;
}

// Out at a speed of their own, a rest, and back.
std::vector<std::string> draw_settings(Draws& draws) {
    constexpr double lead_s = 0.5;
    std::vector<std::string> settings = draw_hand(draws);
    // All joints, or few.
    if (draws.below(2) == 1)
        settings.push_back(fmt::format("statics.active={}", std::lround(draws.scale(10, 100))));
    settings.push_back(fmt::format("run.period_ms={}", std::lround(draws.scale(5, 100))));
    const double way = draws.between(29, 34), out_s = lead_s + way / draws.scale(1.5, 8);
    const double turn_s = out_s + draws.between(0.01, 1);
    settings.push_back("hand.stroke=lead");
    settings.push_back(fmt::format(
        "hand.path=[[{0:.4f}, 0], [{1:.4f}, {2:.3f}], [{3:.4f}, {2:.3f}], [{4:.4f}, 0]]", lead_s,
        out_s, way, turn_s, turn_s + way / draws.scale(1.5, 8)));
    return settings;
}

// All that is wrong with the choices, before the first is played.
void check_choices(const JourneyOptions& options, std::vector<std::vector<std::string>> choices) {
    for (std::vector<std::string>& choice : choices) (void)read_journey(options, choice);
}

bool meets_bars(const JourneyResult& r) {
    const Summary& s = r.summary;
    return r.ripple_N.value_or(0) <= most_ripple_newton && r.cut_share == 0 &&
           s.steps_not_finite == 0 && !s.stopped && !s.went_through;
}

nlohmann::ordered_json as_json(const JourneyResult& r) {
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
                                {"meets_bars", meets_bars(r)},
                                {"out", r.is_out()},
                                {"back", r.is_back()},
                                {"settings", r.settings}};
    if (r.ripple_N) json["ripple_N"] = *r.ripple_N;
    if (r.out_s) json["out_s"] = *r.out_s;
    if (r.back_s) json["back_s"] = *r.back_s;
    if (const auto& journey = r.summary.journey) {
        json["farthest_angstrom"] = journey->farthest;
        json["clearance_angstrom"] = journey->clearance;
        json["closest_angstrom"] = journey->closest;
        json["last_rmsd_angstrom"] = journey->last_rmsd;
    }
    return json;
}

void print_header() {
    fmt::print(
        "| active | T_s, ms | hand | mode | ripple, N | net work, J | off, mJ | at limits, mJ | "
        "error, N | cut, % "
        "| warm, % | nearest, Å | out, Å | after, s | back, Å | after, s | clutches | step, ms |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
        "| --- | --- | --- |\n");
}

void print_row(const JourneyResult& r) {
    const Summary& s = r.summary;
    const Journey journey = s.journey.value_or(Journey{});
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
        100 * s.safety_share, journey.closest, r.is_out() ? "yes, " : "no, ", journey.farthest,
        seconds(r.out_s), r.is_back() ? "yes, " : "no, ", journey.last_rmsd, seconds(r.back_s),
        r.clutches, 1e-3 * s.step_median_us);
    std::fflush(stdout);
}

}  // namespace

bool JourneyResult::is_out() const noexcept {
    return summary.journey && summary.journey->farthest >= 10 && summary.journey->clearance > 4;
}

bool JourneyResult::is_back() const noexcept {
    return is_out() && summary.journey.value_or(Journey{}).last_rmsd <= 1.5;
}

int journey_command(const JourneyOptions& options) {
    std::vector<std::vector<std::string>> choices;
    if (options.random == 0) choices = list_choices(options);
    for (std::size_t i = 0; i < options.random; ++i) {
        Draws draws(options.seed, i);
        choices.push_back(draw_settings(draws));
    }
    check_choices(options, choices);
    const bool is_watched = isatty(STDERR_FILENO) != 0;
    if (!options.json) print_header();
    std::vector<JourneyResult> results;
    for (const std::vector<std::string>& choice : choices) {
        if (is_watched) fmt::print(stderr, "\r{} of {} ", results.size() + 1, choices.size());
        results.push_back(play(options, choice));
        if (!options.json) print_row(results.back());
    }
    const auto count = [&](auto&& holds) { return std::ranges::count_if(results, holds); };
    const auto is_guarded = [](const JourneyResult& r) { return r.mode == "guarded"; };
    const auto out = count([](const JourneyResult& r) { return r.is_out(); });
    const auto back = count([](const JourneyResult& r) { return r.is_back(); });
    const auto missed =
        count([&](const JourneyResult& r) { return is_guarded(r) && !meets_bars(r); });
    if (options.json) {
        nlohmann::ordered_json report{
            {"count", results.size()}, {"out", out}, {"back", back}, {"missed", missed}};
        for (const JourneyResult& result : results) report["journeys"].push_back(as_json(result));
        fmt::print("{}\n", report.dump(2));
    } else {
        fmt::print(
            "\n{} of {} out, {} back; {} of {} guarded ones missed a bar (ripple {} N, nothing "
            "cut at 3 nN or less, finite, none through)\n",
            out, results.size(), back, missed, count(is_guarded), most_ripple_newton);
        for (const JourneyResult& r : results) {
            if (!is_guarded(r) || meets_bars(r)) continue;
            fmt::print("palpa run --headless {} --set \"{}\"\n", options.scene.string(),
                       fmt::join(r.settings, "\" --set \""));
        }
    }
    return missed == 0 ? 0 : 1;
}

}  // namespace palpa
