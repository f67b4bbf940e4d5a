#include "tools/lab/experiments/unbinding.h"

#include "core/draws.h"
#include "core/load_error.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "tools/lab/experiments/scenarios.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>

namespace palpa {
namespace {

// Takes every tick of a run.
class UnbindingWatch {
public:
    UnbindingWatch(const ServoSettings& servo, const World& world)
        : servo_(servo),
          world_(world),
          damping_(static_cast<std::size_t>(servo.delay_ticks) + 1, Vec3::Zero()) {}

    void add(const ServoTick& tick) {
        const Vec3& handle_m = tick.reading.position_m;
        compare();
        played_J_ += felt_newton_.dot(handle_m - handle_m_);
        handle_m_ = handle_m;
        const Vec3& place = tick.contact.molecule.place_angstrom;
        const double now_s = static_cast<double>(ticks_) * servo_tick_s;
        if (ticks_ == 0) start_ = place;
        const double away = (place - start_).norm();
        if (!result_.out_s && away >= 10) result_.out_s = now_s;
        if (result_.out_s && !result_.back_s && away <= 0.3) result_.back_s = now_s;
        if (tick.clutched && !was_clutched_) ++result_.clutches;
        was_clutched_ = tick.clutched;
        since_clutch_ = tick.clutched ? 0 : since_clutch_ + 1;
        is_limited_ =
            is_limited_ || !tick.overtravel_m.isZero() || tick.stage == SafetyStage::ThermalLimit;
        if (tick.clamped && tick.contact.force_newton.norm() <= 3e-9) ++cut_ticks_;
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

    UnbindingResult result() const {
        UnbindingResult result = result_;
        if (compared_ > 0) result.error_N = std::sqrt(squares_ / static_cast<double>(compared_));
        result.cut_share =
            static_cast<double>(cut_ticks_) / std::max(1.0, static_cast<double>(ticks_));
        return result;
    }

private:
    // The simulation has just answered the pose of the tick before, if it is its turn.
    void compare() {
        const ContactModel& answer = contact_at(world_, 0).model;
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
    const World& world_;
    UnbindingResult result_;
    std::vector<Vec3> damping_;
    Vec3 start_ = Vec3::Zero(), felt_newton_ = Vec3::Zero();
    Vec3 handle_m_ = Vec3::Zero();
    std::optional<Answered> answered_;
    double pose_s_ = -1, squares_ = 0, played_J_ = 0;
    std::uint64_t ticks_ = 0, compared_ = 0, cut_ticks_ = 0, since_clutch_ = 0;
    bool was_clutched_ = false, is_limited_ = false;
};

SceneDescription read_unbinding(const UnbindingOptions& options,
                                std::vector<std::string>& settings) {
    settings.emplace_back("run.seconds=200");  // it ends sooner where it succeeds
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    SceneDescription scene = read_scene(options.scene, settings);
    if (!scene.has_statics()) {
        throw LoadError({scene.file.string()},
                        "no molecule of this scene moves by itself, so there is no pocket to "
                        "leave; expected a flexible scene such as scenes/hiv/flexible.toml");
    }
    return scene;
}

// The shortest period that 99 % of steps keep on this machine now, over 10 s of the stroke, ms.
double find_fastest_period(UnbindingOptions options, std::int64_t active) {
    options.settings.push_back(fmt::format("statics.active={}", active));
    options.settings.insert(options.settings.end(), {"run.period_ms=10", "run.seconds=10"});
    return std::ceil(1e-3 * play_unbinding(options, {}).summary.step_p99_us);
}

std::vector<std::vector<std::string>> list_choices(const UnbindingOptions& options) {
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

bool is_to_leave(const SceneDescription& scene) {
    return scene.hands.front().stroke == Stroke::Lead &&
           method_of(scene.statics) == RelaxMethod::SecondOrder &&
           std::ranges::any_of(scene.hands.front().path, [](const PathPoint& point) {
               return std::hypot(point.place[0], point.place[1], point.place[2]) >= 10;
           });
}

// Out at a speed of their own, a rest, and back.
std::vector<std::string> draw_unbinding(Draws& draws) {
    constexpr double lead_s = 0.5;
    std::vector<std::string> settings = draw_hand(draws);
    // All joints, or few.
    if (draws.below(2) == 1)
        settings.push_back(fmt::format("statics.active={}", std::lround(draws.scale(10, 100))));
    settings.push_back(fmt::format("run.period_ms={}", std::lround(draws.scale(5, 100))));
    const double way = draws.between(45, 55), out_s = lead_s + way / draws.scale(1.5, 8);
    const double turn_s = out_s + draws.between(0.01, 1);
    settings.emplace_back("hand.stroke=lead");
    settings.push_back(fmt::format(
        "hand.path=[[{0:.4f}, 0], [{1:.4f}, {2:.3f}], [{3:.4f}, {2:.3f}], [{4:.4f}, 0]]", lead_s,
        out_s, way, turn_s, turn_s + way / draws.scale(1.5, 8)));
    return settings;
}

}  // namespace

bool UnbindingResult::is_out() const noexcept {
    return summary.unbinding && summary.unbinding->farthest >= 10 &&
           summary.unbinding->clearance > 4;
}

bool UnbindingResult::is_back() const noexcept {
    return is_out() && summary.unbinding.value_or(UnbindingPath{}).last_rmsd <= 1.5;
}

bool UnbindingResult::meets_limits() const noexcept {
    return ripple_N.value_or(0) <= most_unbinding_ripple_N && cut_share == 0 &&
           summary.steps_not_finite == 0 && !summary.stopped && !summary.went_through &&
           (is_out() || !is_to_leave);
}

bool UnbindingResult::is_guarded() const noexcept { return mode == "guarded"; }

std::vector<std::vector<std::string>> list_unbindings(const UnbindingOptions& options) {
    std::vector<std::vector<std::string>> choices;
    if (options.random == 0) choices = list_choices(options);
    for (std::size_t i = 0; i < options.random; ++i) {
        Draws draws(options.seed, i);
        choices.push_back(draw_unbinding(draws));
    }
    // All that is wrong with them, before the first is played.
    for (std::vector<std::string> choice : choices) (void)read_unbinding(options, choice);
    return choices;
}

UnbindingResult play_unbinding(const UnbindingOptions& options, std::vector<std::string> settings) {
    const SceneDescription scene = read_unbinding(options, settings);
    World world = load_world(scene);
    EmulatedOmni device(build_emulated_omni(scene, world));
    UnbindingWatch watch(build_servo_settings(scene, world, 0, device.spec()), world);
    const auto begin = std::chrono::steady_clock::now();
    const Summary summary = run_headless(
        scene, world, device, {}, nullptr, {}, {}, [&](const ServoTick& tick) { watch.add(tick); },
        [&] { return watch.is_over(); });
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    UnbindingResult result = watch.result();
    result.settings = settings;
    if (watch.is_over() && summary.ripple) result.ripple_N = summary.ripple->rms;
    result.grip = grip_names[static_cast<std::size_t>(scene.hands.front().grip)];
    result.mode = coupling_mode_names[static_cast<std::size_t>(coupling_of(scene, 0).mode)];
    result.period_ms = scene.period_ms;
    result.active = scene.statics.active;
    result.is_to_leave = is_to_leave(scene);
    result.summary = summary;
    result.wall_s = took.count();
    return result;
}

}  // namespace palpa
