// SpaceMouse and its older kin: a cap that is pushed and turned, two buttons or more, no motors.
// The cap's deflection is the handle's speed. The first button is the clutch, the second gives the
// cap to the camera and back; the light is on while the cap moves the handle.
//
// Ids, reports and dead zones as the open programs spacenavd, PySpaceMouse and VRPN have them;
// nothing was tried on hardware. Little-endian words, -350 to 350 where the cap ends:
//   1: x, y, z, and on newer ones their turns after them; 2: the turns; 3: a bit a button
//   4, out: light on or off
// The cap's axes are x right, y towards the user, z down, turns by the right hand; the handle's
// are x right, y up, z towards the user.
#pragma once
#include "devices/hid_device.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

class SpaceMouseProtocol final : public HidProtocol {
public:
    // Dead zone as a share of the cap's travel, for a resting hand and for crosstalk between axes;
    // assumed. spacenavd uses 2 of 350.
    static constexpr double dead_zone = 0.06;
    static constexpr double full_count = 350;
    // Speeds at full deflection: across the box in two seconds, a quarter turn in one; chosen.
    static constexpr double fastest_m_per_s = 0.060, fastest_rad_per_s = 1.6;

    std::string_view name() const noexcept override { return "SpaceMouse"; }
    bool is_ours(const HidPlace& place) const noexcept override;
    std::string why_not(const HidPlace& place) const override;
    bool is_talkative() const noexcept override { return false; }
    DeviceCheck begin(HidLine& line, const HidPlace& place) noexcept override;
    bool decode(HidBytes report, HidInput& input) noexcept override;
    HidBytes encode(const HidOutput& output) noexcept override;
    void forget() noexcept override { is_lit_.reset(); }
    double least_s() const noexcept override { return 0.008; }

private:
    std::array<std::uint8_t, 2> light_{};
    std::optional<bool> is_lit_;
};

// For the list of devices.
OpenedDevice open_space_mouse(const DeviceRequest& request);

}  // namespace palpa
