#include "devices/scripted_hand.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

// A clutch takes 1.4 s: wait until the handle has caught up, press, carry, let it settle, release.
constexpr double wait_s = 0.5, press_s = 0.1, carry_s = 0.5, settle_s = 0.3;

}  // namespace

ScriptedHand::ScriptedHand(HandScript script, double half_width_m)
    : script_(std::move(script)), reach_m_(half_width_m - stop_margin_m) {
    restart();
}

void ScriptedHand::restart() noexcept {
    const double start = find_target(script_.path, 0);
    script_time_s_ = 0;
    clutch_time_s_ = -1;
    last_x_m_ = std::clamp(start, -reach_m_, reach_m_);
    shift_m_ = last_x_m_ - start;
}

ScriptedHand::Wish ScriptedHand::step(double tick_s) noexcept {
    const double before = last_x_m_;
    if (clutch_time_s_ < 0) {
        const double next = find_target(script_.path, script_time_s_) + shift_m_;
        // A nanometre over the edge is rounding.
        if (std::abs(next) > reach_m_ + 1e-9 && std::abs(next) > std::abs(before)) {
            clutch_time_s_ = 0;
            carry_from_m_ = before;
            carry_m_ = std::copysign(reach_m_, -next) - before;
        } else {
            script_time_s_ += tick_s;
            last_x_m_ = next;
        }
    }
    std::uint32_t buttons = 0;
    if (clutch_time_s_ >= 0) {
        const double since_press = clutch_time_s_ - wait_s;
        if (since_press >= 0) buttons = static_cast<std::uint32_t>(Button::Clutch);
        last_x_m_ = carry_from_m_ + carry_m_ * minimum_jerk((since_press - press_s) / carry_s);
        clutch_time_s_ += tick_s;
        if (since_press > press_s + carry_s + settle_s) {
            clutch_time_s_ = -1;
            shift_m_ += carry_m_;
        }
    }
    return {last_x_m_, (last_x_m_ - before) / tick_s, buttons};
}

double ScriptedHand::kick_newton(double time_s) const noexcept {
    const double since = time_s - script_.kick_time_s;
    // Half a nanosecond keeps the count of ticks from hanging on rounding.
    const bool now = since > -5e-10 && since < script_.kick_duration_s - 5e-10;
    return now ? script_.kick_N_s / script_.kick_duration_s : 0;
}

}  // namespace palpa
