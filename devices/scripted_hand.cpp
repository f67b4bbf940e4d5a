#include "devices/scripted_hand.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace palpa {
namespace {

// A clutch takes 1.4 s: wait until the handle has caught up, press, carry, let it settle, release.
constexpr double wait_s = 0.5, press_s = 0.1, carry_s = 0.5, settle_s = 0.3;

// One that leads makes up for what the molecule lags in the former time, waits where that is more
// than the way, and is never faster than a careful hand.
constexpr double catch_up_s = 0.5, waits_from_m = 1e-10, careful_m_per_s = 0.08;

// The direction of the place that is furthest from the first.
Vec3 find_longest_way(const std::vector<HandWaypoint>& path) noexcept {
    Vec3 longest = Vec3::Zero();
    for (const HandWaypoint& point : path) {
        const Vec3 way = Vec3(point.x_m, point.y_m, point.z_m) -
                         Vec3(path.front().x_m, path.front().y_m, path.front().z_m);
        if (way.squaredNorm() > longest.squaredNorm()) longest = way;
    }
    return longest.stableNormalized();
}

// Of the stretch of a path that is gone at `time_s`, or of the last one before; 0 before the first.
Vec3 find_last_way(const std::vector<HandWaypoint>& path, double time_s) noexcept {
    Vec3 last = Vec3::Zero();
    for (std::size_t i = 1; i < path.size() && path[i - 1].time_s < time_s; ++i) {
        const HandWaypoint &from = path[i - 1], &to = path[i];
        const Vec3 way(to.x_m - from.x_m, to.y_m - from.y_m, to.z_m - from.z_m);
        if (!way.isZero(0)) last = way;
    }
    return last;
}

}  // namespace

ScriptedHand::ScriptedHand(HandScript script, const Vec3& half_workspace_m, double most_ahead_m)
    : script_(std::move(script)),
      reach_m_(half_workspace_m.array() - stop_margin_m),
      most_ahead_m_(most_ahead_m) {
    restart();
}

void ScriptedHand::restart() noexcept {
    HandTarget start = find_target(script_.path, 0);
    if (script_.leads) start.place_m = -find_longest_way(script_.path).cwiseProduct(reach_m_);
    first_sight_.reset();
    sight_.reset();
    script_time_s_ = 0;
    clutch_time_s_ = -1;
    last_m_ = start.place_m.cwiseMax(-reach_m_).cwiseMin(reach_m_);
    shift_m_ = last_m_ - start.place_m;
    orientation_ = start.orientation;
}

ScriptedHand::Wish ScriptedHand::step(double tick_s) noexcept {
    const Vec3 before = last_m_;
    if (clutch_time_s_ < 0) {
        const double time_s = script_time_s_;
        Vec3 next = script_.leads ? lead(tick_s) : follow_script(tick_s);
        carry_m_ = find_carry(before, next);
        if (!carry_m_.isZero() && !is_worth_clutching(carry_m_)) {
            carry_m_.setZero();
            next = next.cwiseMax(-reach_m_).cwiseMin(reach_m_);
        }
        if (!carry_m_.isZero()) {
            clutch_time_s_ = 0;
            carry_from_m_ = before;
            script_time_s_ = time_s;
        } else {
            last_m_ = next;
        }
    }
    std::uint32_t buttons = 0;
    if (clutch_time_s_ >= 0) {
        const double since_press = clutch_time_s_ - wait_s;
        if (since_press >= 0) buttons = static_cast<std::uint32_t>(Button::Clutch);
        last_m_ = carry_from_m_ + carry_m_ * minimum_jerk((since_press - press_s) / carry_s);
        clutch_time_s_ += tick_s;
        if (since_press > press_s + carry_s + settle_s) {
            clutch_time_s_ = -1;
            shift_m_ += carry_m_;
        }
    }
    return {last_m_, (last_m_ - before) / tick_s, orientation_, buttons};
}

void ScriptedHand::see(const Sight& sight) noexcept {
    const bool holds_other = takes_anew_ && sight_ && sight_->grip_number != sight.grip_number;
    if (!first_sight_ || holds_other) {
        first_sight_ = sight;
        takes_anew_ = false;
    }
    sight_ = sight;
}

void ScriptedHand::go_on(const std::vector<HandWaypoint>& path, bool takes_anew) {
    const Vec3 now = takes_anew ? Vec3::Zero() : find_target(script_.path, script_time_s_).place_m;
    takes_anew_ = takes_anew;
    script_.path = {{script_time_s_, now.x(), now.y(), now.z()}};
    for (HandWaypoint point : path) {
        point.time_s += script_time_s_;
        if (point.time_s > script_.path.back().time_s) script_.path.push_back(point);
    }
}

Vec3 ScriptedHand::follow_script(double tick_s) noexcept {
    const HandTarget target = find_target(script_.path, script_time_s_);
    script_time_s_ += tick_s;
    orientation_ = target.orientation;
    return target.place_m + shift_m_;
}

Vec3 ScriptedHand::lead(double tick_s) noexcept {
    if (!sight_ || !first_sight_) return last_m_;
    const Vec3 target = find_target(script_.path, script_time_s_).place_m;
    const Vec3 lag = find_lag();
    Vec3 molecule_m_per_s = lag / catch_up_s;
    if (lag.norm() < waits_from_m) {
        script_time_s_ += tick_s;
        molecule_m_per_s += (find_target(script_.path, script_time_s_).place_m - target) / tick_s;
    }
    Vec3 step = sight_->displacement_gain * tick_s * molecule_m_per_s;
    const double longest = careful_m_per_s * tick_s, length = step.stableNorm();
    if (!step.allFinite()) return last_m_;
    if (length > longest) step *= longest / length;
    const Vec3 ahead = last_m_ + step - sight_->handle_m;
    return sight_->handle_m + ahead * std::min(1.0, most_ahead_m_ / std::max(ahead.norm(), 1e-12));
}

Vec3 ScriptedHand::find_lag() const noexcept {
    return find_target(script_.path, script_time_s_).place_m -
           (sight_->molecule_m - first_sight_->molecule_m);
}

// A molecule that heat shakes beyond the edge comes back by itself; clutching would only lose time.
bool ScriptedHand::is_worth_clutching(const Vec3& carry) const noexcept {
    if (!script_.leads || find_lag().norm() >= waits_from_m) return true;
    return find_last_way(script_.path, script_time_s_).dot(carry) < 0;
}

Vec3 ScriptedHand::find_carry(const Vec3& before, const Vec3& next) const noexcept {
    Vec3 carry = Vec3::Zero();
    for (Eigen::Index i = 0; i < 3; ++i) {
        // A nanometre over the edge is rounding.
        const bool leaves = std::abs(next(i)) > reach_m_(i) + 1e-9;
        if (leaves && std::abs(next(i)) > std::abs(before(i)))
            carry(i) = std::copysign(reach_m_(i), -next(i)) - before(i);
    }
    return carry;
}

double ScriptedHand::kick_newton(double time_s) const noexcept {
    const double since = time_s - script_.kick_time_s;
    // Half a nanosecond keeps the count of ticks from hanging on rounding.
    const bool now = since > -5e-10 && since < script_.kick_duration_s - 5e-10;
    return now ? script_.kick_N_s / script_.kick_duration_s : 0;
}

}  // namespace palpa
