#include "devices/scripted_hand.h"

#include <cmath>
#include <utility>

namespace palpa {
namespace {

// A clutch takes 0.8 s: press, carry, let the hand settle, release.
constexpr double press_s = 0.1, carry_s = 0.5, settle_s = 0.2;
// The hand turns back this far before the stop, and carries the handle to as far from the other.
constexpr double margin_m = 0.005;

}  // namespace

ScriptedHand::ScriptedHand(HandScript script, double half_width_m)
    : script_(std::move(script)), reach_m_(half_width_m - margin_m) {
    last_x_m_ = find_target(script_.path, 0);
}

ScriptedHand::Wish ScriptedHand::step(double tick_s) noexcept {
    const double before = last_x_m_;
    if (clutch_time_s_ < 0) {
        const double next = find_target(script_.path, script_time_s_) + shift_m_;
        const bool outward = std::abs(next) > std::abs(before);
        if (std::abs(next) > reach_m_ && outward) {
            clutch_time_s_ = 0;
            carry_from_m_ = before;
            carry_m_ = std::copysign(2 * reach_m_, -next);
        } else {
            script_time_s_ += tick_s;
            last_x_m_ = next;
        }
    }
    std::uint32_t buttons = 0;
    if (clutch_time_s_ >= 0) {
        buttons = static_cast<std::uint32_t>(Button::Clutch);
        last_x_m_ = carry_from_m_ + carry_m_ * minimum_jerk((clutch_time_s_ - press_s) / carry_s);
        clutch_time_s_ += tick_s;
        if (clutch_time_s_ > press_s + carry_s + settle_s) {
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
