#include "experiments/play_lesson.h"

#include "core/draws.h"
#include "core/units.h"
#include "devices/emulated_hand.h"
#include "devices/emulated_omni.h"
#include "devices/mouse_handle.h"
#include "experiments/emulated_hand.h"
#include "experiments/mouse_person.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "session/edit_player.h"
#include "session/lesson.h"
#include "session/lesson_meter.h"
#include "session/lockstep.h"
#include "session/plan_hand.h"
#include "session/run_headless.h"
#include "session/undo_history.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
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
    HandDescription hand = scene.hands.front();
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

// A hand on a device, which leads the molecule along paths.
class LessonHand {
public:
    LessonHand() = default;
    LessonHand(const LessonHand&) = delete;
    LessonHand& operator=(const LessonHand&) = delete;
    virtual ~LessonHand() = default;

    virtual Device& device() noexcept = 0;
    // Goes on along this path, from where it is, or from where it takes hold of another molecule.
    virtual void go_on(const std::vector<HandWaypoint>& path, bool takes_anew) = 0;
    virtual void see(const ServoTick& /*tick*/) {}
};

class OmniHand final : public LessonHand {
public:
    explicit OmniHand(const EmulatedOmniSettings& settings) : omni_(settings) {}

    Device& device() noexcept override { return omni_; }
    void go_on(const std::vector<HandWaypoint>& path, bool takes_anew) override {
        omni_.go_on(path, takes_anew);
    }

private:
    EmulatedOmni omni_;
};

// A person at a mouse, for whom the path is a goal in the picture that waits for the molecule.
class MouseHand final : public LessonHand {
public:
    MouseHand(const EmulatedOmniSettings& settings, std::uint64_t seed)
        : mouse_(build_mouse(settings, &orders_)),
          person_(mouse_reach_m(settings), orders_, seed) {}

    Device& device() noexcept override { return mouse_; }
    void go_on(const std::vector<HandWaypoint>& path, bool takes_anew) override {
        const Vec3 now = takes_anew ? Vec3::Zero() : find_target(path_, time_s_).place_m;
        if (takes_anew) grip_number_.reset();
        path_ = {{time_s_, now.x(), now.y(), now.z()}};
        for (HandWaypoint point : path) {
            point.time_s += time_s_;
            if (point.time_s > path_.back().time_s) path_.push_back(point);
        }
    }
    void see(const ServoTick& tick) override {
        constexpr double waits_from_angstrom = 1;
        const MoleculePose& molecule = tick.contact.molecule;
        if (tick.contact.is_still) return;
        if (!grip_number_ || *grip_number_ != tick.contact.grip_number)
            first_angstrom_ = molecule.place_angstrom;
        grip_number_ = tick.contact.grip_number;
        const auto goal = [&]() -> Vec3 {
            return first_angstrom_ +
                   units::angstrom_per_metre * find_target(path_, time_s_).place_m;
        };
        if ((goal() - molecule.place_angstrom).norm() < waits_from_angstrom)
            time_s_ += servo_tick_s;
        person_.see(tick, goal());
    }

private:
    HandOrders orders_;
    MouseHandle mouse_;
    MousePersonAtWindow person_;
    std::vector<HandWaypoint> path_{{}};
    double time_s_ = 0;                         // on the path
    std::optional<std::uint32_t> grip_number_;  // of the contact model when it took hold
    Vec3 first_angstrom_ = Vec3::Zero();        // place of the molecule then
};

std::unique_ptr<LessonHand> open_hand(const SceneDescription& scene, const World& world,
                                      LessonDevice device, std::uint64_t seed) {
    EmulatedOmniSettings settings = build_emulated_omni(scene, world);
    if (device == LessonDevice::Mouse) return std::make_unique<MouseHand>(settings, seed);
    constexpr double small_m = 0.05;
    if (device == LessonDevice::Small) settings.half_workspace_m.setConstant(0.5 * small_m);
    return std::make_unique<OmniHand>(settings);
}

class LessonPlay {
public:
    LessonPlay(const SceneDescription& scene, LessonPlayer player, LessonDevice device,
               std::uint64_t seed)
        : scene_(scene),
          player_(player),
          world_(load_world(scene)),
          hand_(open_hand(scene, world_, device, seed)),
          lesson_(scene.lesson),
          meter_(scene, world_),
          edits_(scene),
          hands_{{hand_->device(), build_servo_settings(scene, world_, 0, hand_->device().spec()),
                  contact_at(world_, 0)}} {
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
            return std::vector{contact_at(world_, 0)};
        };
        const auto on_ticks = [&](std::span<const ServoTick> now) {
            const std::size_t before = lesson_.current();
            hand_->see(now.front());
            statistics_.add(now.front());
            note(now.front());
            if (progress && lesson_.current() != before)
                progress(static_cast<double>(lesson_.current()) /
                         static_cast<double>(result_.steps.size()));
        };
        run_lockstep({ticks, ticks_per_step}, hands_, step, on_ticks,
                     [&] { return lesson_.is_done(); });
        result_.seconds = static_cast<double>(ticks_) * servo_tick_s;
        result_.travel = statistics_.summary().travel;
        return result_;
    }

private:
    void note(const ServoTick& tick) {
        ++ticks_;
        if (lesson_.is_done()) return;
        const CouplingMode mode = coupling_of(world_, hand_at(world_, 0)).description.mode;
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
        if (begin_step() || !due.empty()) renew_servos(scene_, world_, hands_);
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
        if (!step.operator_take.empty()) apply(GrabEdit{step.operator_take}, ".operator_take");
        if (!step.operator_coupling.empty())
            apply(CouplingEdit{step.operator_coupling}, ".operator_coupling");
        hand_->go_on(plan_lead(step.operator_path), !step.operator_take.empty());
        return !step.operator_take.empty() || !step.operator_coupling.empty();
    }

    const SceneDescription& scene_;
    LessonPlayer player_;
    World world_;
    std::unique_ptr<LessonHand> hand_;
    Lesson lesson_;
    LessonMeter meter_;
    EditPlayer edits_;
    UndoHistory history_;
    std::vector<LockstepHand> hands_;
    std::uint64_t ticks_ = 0;
    bool has_begun_ = false;  // the present step
    Statistics statistics_{servo_tick_s};
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

LessonResult play_lesson(SceneDescription scene, LessonPlayer player, LessonDevice device,
                         std::uint64_t seed, const std::function<void(double)>& progress) {
    scene.hands = {hand_of(scene, player, seed)};
    LessonPlay play(scene, player, device, seed);
    return play.run(progress);
}

}  // namespace palpa
