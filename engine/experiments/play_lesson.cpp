#include "experiments/play_lesson.h"

#include "core/draws.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "session/edit_player.h"
#include "session/lesson.h"
#include "session/lesson_meter.h"
#include "session/lockstep.h"
#include "session/plan_hand.h"
#include "session/run_headless.h"
#include "simulation/edit.h"
#include "simulation/held.h"
#include "simulation/load.h"
#include "simulation/step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace palpa {
namespace {

constexpr double seconds_for_a_step = 4, seconds_between_places = 2.5;

// mm; the middle of the workspace.
std::vector<PathPoint> draw_wander(double seconds, std::uint64_t seed) {
    const std::array<double, 3> reach{40, 30, 20};
    Draws draws(seed, 0);
    std::vector<PathPoint> path{{0.01, {}, {}}};
    for (double time = seconds_between_places; time < seconds; time += seconds_between_places) {
        PathPoint point{time, {}, {}};
        for (std::size_t axis = 0; axis < reach.size(); ++axis)
            point.place[axis] = draws.between(-reach[axis], reach[axis]);
        path.push_back(point);
    }
    return path;
}

HandDescription hand_of(const SceneDescription& scene, LessonPlayer player, std::uint64_t seed) {
    HandDescription hand = scene.hand;
    hand.release_s.reset();
    hand.kick_N_s = 0;
    hand.stroke = player == LessonPlayer::Operator ? Stroke::Lead : Stroke::Path;
    hand.path = {{0.01, {}, {}}};
    if (player == LessonPlayer::Random) hand.path = draw_wander(lesson_seconds(scene), seed);
    return hand;
}

// How far a value is from what a step wants; 0 where it will do.
double find_lack(const LessonStepDescription& step, double value) {
    return std::max({step.at_least ? *step.at_least - value : 0,
                     step.at_most ? value - *step.at_most : 0, 0.0});
}

class LessonPlay {
public:
    LessonPlay(const SceneDescription& scene, LessonPlayer player)
        : scene_(scene),
          player_(player),
          world_(load_world(scene)),
          device_(build_emulated_omni(scene, world_)),
          lesson_(scene.lesson),
          meter_(scene, world_),
          edits_(scene),
          hands_{{device_, build_servo_settings(scene, world_, device_.spec()),
                  local_contact_of(world_)}} {
        result_.steps.resize(scene.lesson.size());
    }

    LessonResult run(const std::function<void(double)>& progress) {
        const auto ticks =
            static_cast<std::uint64_t>(std::ceil(lesson_seconds(scene_) * servo_rate_hz));
        const auto ticks_per_step = static_cast<std::uint64_t>(
            std::lround(world_.resource<Clock>().period_s * servo_rate_hz));
        const auto step = [&](std::span<const HandPose> poses, std::span<const ContactModel> felt) {
            make_edits();
            (void)step_world(world_, {poses, felt});
            meter_.measure(world_);
            return std::vector{local_contact_of(world_)};
        };
        const auto on_ticks = [&](std::span<const ServoTick> now) {
            const std::size_t before = lesson_.current();
            note(now.front());
            if (progress && lesson_.current() != before)
                progress(static_cast<double>(lesson_.current()) /
                         static_cast<double>(result_.steps.size()));
        };
        run_lockstep({ticks, ticks_per_step}, hands_, step, on_ticks,
                     [&] { return lesson_.is_done(); });
        result_.seconds = static_cast<double>(ticks_) * servo_tick_s;
        return result_;
    }

private:
    void note(const ServoTick& tick) {
        ++ticks_;
        if (lesson_.is_done()) return;
        const CouplingMode mode = world_.resource<SceneFile>().scene.coupling.mode;
        lesson_.update(read_tick(tick), mode, meter_.measures().values);
        const LessonStepDescription& step = lesson_.steps()[lesson_.current()];
        if (player_ == LessonPlayer::Operator && step.question && has_begun_)
            lesson_.answer(static_cast<std::size_t>(step.question->right) - 1);
        LessonStepResult& result = result_.steps[lesson_.current()];
        result.was_reached = true;
        result.at_s = static_cast<double>(ticks_) * servo_tick_s;
        result.is_done = lesson_.is_step_done();
        const std::optional<double> value = lesson_.value();
        if (value && (!result.value || find_lack(step, *value) <= find_lack(step, *result.value)))
            result.value = value;
        if (!result.is_done) return;
        lesson_.skip();
        has_begun_ = false;
    }

    // Of the scene, and of the operator as a step begins.
    void make_edits() {
        const std::vector<EditDescription> due =
            edits_.take_due(static_cast<double>(ticks_ - 1) * servo_tick_s);
        for (const EditDescription& edit : due) history_.apply(world_, edit);
        if (begin_step() || !due.empty()) renew_servos(world_, hands_);
    }

    // Whether that was an edit.
    bool begin_step() {
        if (has_begun_ || lesson_.is_done()) return false;
        has_begun_ = true;
        if (player_ != LessonPlayer::Operator) return false;
        const LessonStepDescription& step = lesson_.steps()[lesson_.current()];
        const std::string key = "lesson." + step.name;
        const auto apply = [&](EditAction action, const std::string& of) {
            history_.apply(world_, {0, 0, std::move(action), scene_.place_of(key + of)});
        };
        if (!step.operator_take.empty()) apply(TakeEdit{step.operator_take}, ".operator_take");
        if (!step.operator_coupling.empty())
            apply(CouplingEdit{step.operator_coupling}, ".operator_coupling");
        device_.go_on(plan_lead(step.operator_path), !step.operator_take.empty());
        return !step.operator_take.empty() || !step.operator_coupling.empty();
    }

    const SceneDescription& scene_;
    LessonPlayer player_;
    World world_;
    EmulatedOmni device_;
    Lesson lesson_;
    LessonMeter meter_;
    EditPlayer edits_;
    EditHistory history_;
    std::vector<LockstepHand> hands_;
    std::uint64_t ticks_ = 0;
    bool has_begun_ = false;  // the present step
    LessonResult result_;
};

}  // namespace

bool LessonResult::is_done() const noexcept {
    return std::ranges::all_of(steps, &LessonStepResult::is_done);
}

double lesson_seconds(const SceneDescription& scene) noexcept {
    double seconds = 0;
    for (const LessonStepDescription& step : scene.lesson) {
        const double path_s = step.operator_path.empty() ? 0 : step.operator_path.back().time_s;
        seconds += 1.25 * path_s + step.for_s + seconds_for_a_step;
    }
    return seconds;
}

LessonResult play_lesson(SceneDescription scene, LessonPlayer player, std::uint64_t seed,
                         const std::function<void(double)>& progress) {
    scene.hand = hand_of(scene, player, seed);
    scene.second.reset();
    LessonPlay play(scene, player);
    return play.run(progress);
}

}  // namespace palpa
