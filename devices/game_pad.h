// A game pad of the window whose buttons the windowing library knows (Xbox-class), without force.
// It senses no position: the sticks set the speed of a virtual handle (devices/rate_handle.h) on
// the servo's clock, one tick per read. Left stick: right and up; right stick: towards the person,
// and turning about the vertical axis. The right shoulder button is the clutch.
#pragma once
#include "devices/device_check.h"
#include "devices/rate_handle.h"
#include "haptics/device.h"
#include "haptics/hand.h"

#include <cstdint>

namespace palpa {

class GamePad final : public Device {
public:
    // As for the other pads (devices/sony_pad.h): a stick that springs back does not rest exactly
    // in the middle.
    static constexpr double dead_zone = 0.12;
    static constexpr double fastest_m_per_s = 0.060, fastest_rad_per_s = 1.6;
    // Number of ticks without news from the window after which the sticks count as released.
    static constexpr int silent_ticks = 250;

    explicit GamePad(PadLink& link);

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& /*force_newton*/) noexcept override {}
    std::string_view status() const noexcept override;

private:
    PadLink& link_;
    DeviceSpec spec_;
    PadInput input_;
    int silent_for_ticks_ = 0;
    RateHandle handle_;
    std::uint64_t ticks_ = 0;
};

// Fails without a window.
OpenedDevice open_game_pad(const DeviceRequest& request);
bool is_game_pad_there(const DeviceRequest& request);

}  // namespace palpa
