// A game pad that the window sees, of the kind that the windowing library knows the buttons of
// (Xbox-class). Without force. It senses no place: the sticks are the speed of a handle that is not
// there (devices/rate_handle.h), on the servo's clock, a tick a read. Left stick: right and up;
// right stick: towards the person, and turned about the upright. The right shoulder is the clutch.
#pragma once
#include "devices/device_check.h"
#include "devices/rate_handle.h"
#include "haptics/device.h"
#include "haptics/hand.h"

#include <cstdint>

namespace palpa {

class GamePad final : public Device {
public:
    // As the other pads' (devices/sony_pad.h); a stick that springs back is not quite in the
    // middle.
    static constexpr double dead_zone = 0.12;
    static constexpr double fastest_m_per_s = 0.060, fastest_rad_per_s = 1.6;
    // A window that hangs posts nothing: after so many ticks the sticks count as let go.
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

// Without a window there is none.
OpenedDevice open_game_pad(const DeviceRequest& request);
bool is_game_pad_there(const DeviceRequest& request);

}  // namespace palpa
