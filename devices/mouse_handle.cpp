#include "devices/mouse_handle.h"

#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

// `way`, but no longer than that.
Vec3 shortened(const Vec3& way, double longest) noexcept {
    return way * std::min(1.0, longest / std::max(way.stableNorm(), 1e-12));
}

}  // namespace

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
      kept_(std::exp(-settings.stiffness_N_per_m * servo_tick_s / settings.damping_N_s_per_m)) {
    spec_.name = "mouse and keys";
    spec_.is_real = false;
    spec_.half_workspace_m = settings.half_workspace_m;
}

DeviceReading MouseHandle::read() noexcept {
    return {static_cast<double>(tick_) * servo_tick_s, handle_m_, 0, true};
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
    const Vec3& reach = settings_.half_workspace_m;
    handle_m_ = (rest_m + kept_ * (handle_m_ - rest_m)).cwiseMax(-reach).cwiseMin(reach);
}

void MouseHandle::step_wish() noexcept {
    wish_m_ += shortened(time_.target_m() - wish_m_, live_hand_m_per_s * servo_tick_s);
    wish_m_ =
        handle_m_ + shortened(wish_m_ - handle_m_, live_hand_newton / settings_.stiffness_N_per_m);
}

}  // namespace palpa
