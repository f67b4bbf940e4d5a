// A handle for somebody with mouse and keys alone. Nothing is felt; what is seen is how far the
// handle stays behind the mouse (pseudo-haptics: A. Lecuyer, Presence 18(1), 2009, changes the
// ratio of control to display in the same way). The hand draws a handle without mass to where the
// mouse wants it, p, against the force F that a motor would play:
//
//   B dx/dt = K (p - x) + F
//
// At rest x = p + F/K: the gap shows the force. Where the molecule feels like a spring K_felt, the
// handle goes by dx/dp = K/(K + K_felt). K and B are by default the medium grip's (haptics/hand.h),
// whose values are assumed; without a mass the handle is there in B/K = 20 ms, about a frame.
//
// A mouse has no end: the workspace is not bounded. While the clutch is pressed (the window's Space
// is released), the handle returns to the middle.
#pragma once
#include "core/omni.h"
#include "devices/ordered_time.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "math/vec.h"

#include <cstdint>
#include <optional>

namespace palpa {

struct MouseHandleSettings {
    double stiffness_N_per_m = 200;  // K
    double damping_N_s_per_m = 4;    // B
    double peak_force_newton =
        omni_peak_newton;          // as for the emulated Omni, so that scenes feel alike
    int delay_ticks = 1;           // of the servo's forces
    HandOrders* orders = nullptr;  // targets from the window; null: p stays in the middle
};

// Spring and damper of a hand with this grip; without a grip those of the medium one.
MouseHandleSettings mouse_handle_of(const std::optional<HandModel>& hand) noexcept;

// The stiffness felt (N/m) from which on the handle shakes: where
//     z^d (z - a) + (1 - a) K_felt/K = 0,  a = e^(-K T/B),
// has a root on the unit circle; T the tick, d the delay in ticks. 4.1 N/mm for a medium grip and
// d = 1.
double calm_mouse_stiffness(const MouseHandleSettings& settings) noexcept;

// Time is the servo's: each write moves the handle on by one tick, exactly where p and F are held
// meanwhile: no K shakes by itself. The device's cap of the stiffness felt is half of
// `calm_mouse_stiffness`.
//
// p goes after the mouse no faster than `live_hand_m_per_s`, and is never so far ahead of the
// handle that it pulls with more than `live_hand_newton`. The handle goes no farther ahead of a
// molecule that waits for its contact model than `waits_from_m`, so that no travel is clipped.
class MouseHandle final : public Device {
public:
    explicit MouseHandle(const MouseHandleSettings& settings);

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override;
    void show(const ContactModel& contact, const Vec3& waiting_m) noexcept override;

    static constexpr double waits_from_m = 0.01;

    const Vec3& wish_m() const noexcept { return wish_m_; }  // p

private:
    void step_wish() noexcept;

    MouseHandleSettings settings_;
    DeviceSpec spec_;
    OrderedTime time_;
    double
        kept_;  // e^(-K T/B): share of the distance to the rest position that remains after a tick
    std::uint64_t tick_ = 0;
    Vec3 wish_m_ = Vec3::Zero(), handle_m_ = Vec3::Zero();
    Vec3 waiting_m_ = Vec3::Zero();  // travel that the molecule has yet to follow
};

}  // namespace palpa
