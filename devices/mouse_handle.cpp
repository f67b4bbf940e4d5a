#include "devices/mouse_handle.h"

#include "core/repeatable.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa {

double calm_mouse_stiffness(const MouseHandleSettings& settings) noexcept {
    const double K = settings.stiffness_N_per_m;
    const double kept = repeatable::exp(-K * servo_tick_s / settings.damping_N_s_per_m);
    // The phase of z^d (z - a) on the unit circle grows with the angle of z; pi makes it negative.
    const auto phase_of = [&](double angle) {
        return settings.delay_ticks * angle +
               repeatable::atan2(repeatable::sin(angle), repeatable::cos(angle) - kept);
    };
    double below = 0, above = std::numbers::pi;
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (below + above);
        (phase_of(middle) < std::numbers::pi ? below : above) = middle;
    }
    const double magnitude =
        repeatable::hypot(repeatable::sin(above), repeatable::cos(above) - kept);
    return K * magnitude / (1 - kept);
}

MouseHandleSettings mouse_handle_of(const std::optional<HandModel>& hand) noexcept {
    MouseHandleSettings settings;
    if (hand && hand->stiffness_N_per_m > 0 && hand->damping_N_s_per_m > 0) {
        settings.stiffness_N_per_m = static_stiffness(*hand);
        settings.damping_N_s_per_m = hand->damping_N_s_per_m;
    }
    return settings;
}

MouseHandle::MouseHandle(const MouseHandleSettings& settings)
    : settings_(settings),
      time_(settings.orders),
      kept_(repeatable::exp(-settings.stiffness_N_per_m * servo_tick_s /
                            settings.damping_N_s_per_m)) {
    spec_.name = "mouse and keys";
    spec_.is_real = false;
    spec_.cap_N_per_m = 0.5 * calm_mouse_stiffness(settings);
}

DeviceReading MouseHandle::read() noexcept {
    return {static_cast<double>(tick_) * servo_tick_s, handle_m_, time_.buttons(), true};
}

void MouseHandle::show(const ContactModel& /*contact*/, const Vec3& waiting_m) noexcept {
    waiting_m_ = waiting_m;
}

void MouseHandle::write(const Vec3& force_newton) noexcept {
    if (!time_.step()) return;
    ++tick_;
    if (time_.was_restarted()) wish_m_ = handle_m_;
    step_wish();
    const Vec3 force = force_newton.allFinite()
                           ? shortened(force_newton, settings_.peak_force_newton)
                           : Vec3(Vec3::Zero());
    const Vec3 rest_m = wish_m_ + force / settings_.stiffness_N_per_m;
    Vec3 moved_m = (1 - kept_) * (rest_m - handle_m_);
    const double waiting = waiting_m_.norm();
    if (waiting >= waits_from_m && !time_.is_clutched()) {
        const Vec3 ahead = waiting_m_ / waiting;
        moved_m -= std::max(0.0, moved_m.dot(ahead)) * ahead;
    }
    handle_m_ += moved_m;
}

void MouseHandle::step_wish() noexcept {
    wish_m_ += shortened(time_.target_m() - wish_m_, live_hand_m_per_s * servo_tick_s);
    wish_m_ =
        handle_m_ + shortened(wish_m_ - handle_m_, live_hand_newton / settings_.stiffness_N_per_m);
}

}  // namespace palpa
