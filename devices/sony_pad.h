// DualSense and DualShock 4, by cable and by Bluetooth. The left stick moves the handle right and
// up, the right one towards the user and about the vertical; while L1 is held the handle turns with
// the pad. R1 is the clutch, the triangle gives the sticks to the camera and back.
//
// The force has no direction here. DualSense: both triggers resist in proportion to its norm, and
// the left motor rumbles when it rises. DualShock 4: the small motor in proportion, the large one
// when it rises.
//
// Reports as Linux's hid-playstation describes them, trigger effects as the open programs
// dualsensectl and pydualsense do; nothing was tried on hardware. Effect 1 resists from a place on
// the way (0: all of it) with 0 to 255, of which the maker's own effect 0x21 has eight; 5 is none.
// By Bluetooth reports end with CRC-32 of 0xA1 (in) or 0xA2 (out) and all bytes before.
#pragma once
#include "devices/hid_device.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace palpa {

enum class SonyModel { DualSense, DualShock4 };

class SonyPadProtocol final : public HidProtocol {
public:
    // Dead zone as a share of a stick's travel, because the stick does not return exactly to its
    // middle; assumed.
    static constexpr double dead_zone = 0.12;
    // Speeds at full deflection; chosen, as for the SpaceMouse.
    static constexpr double fastest_m_per_s = 0.060, fastest_rad_per_s = 1.6;
    // A full-scale gyroscope value is 2000 degrees per second; the calibration of the single pad is
    // not read. Values at rest stay below the dead zone.
    static constexpr double gyro_deg_per_s = 2000.0 / 32768, gyro_dead_deg_per_s = 2;

    explicit SonyPadProtocol(SonyModel model) noexcept : model_(model) {}

    std::string_view name() const noexcept override;
    bool is_ours(const HidPlace& place) const noexcept override;
    bool is_talkative() const noexcept override { return true; }
    void describe(DeviceSpec& spec) const noexcept override { spec.shakes = true; }
    DeviceCheck begin(HidLine& line, const HidPlace& place) noexcept override;
    bool decode(HidBytes report, HidInput& input) noexcept override;
    HidBytes encode(const HidOutput& output) noexcept override;
    double least_s() const noexcept override;

    // Sets the connection; begin() determines it.
    void use_bluetooth(bool is_bluetooth) noexcept { is_bluetooth_ = is_bluetooth; }

private:
    HidBytes encode_dualsense(const HidOutput& output) noexcept;
    HidBytes encode_dualshock(const HidOutput& output) noexcept;

    SonyModel model_;
    bool is_bluetooth_ = false;
    std::uint8_t sequence_ = 0;  // sequence number of Bluetooth reports, 0 to 15
    std::array<std::uint8_t, 78> report_{};
};

// For the list of devices.
OpenedDevice open_dualsense(const DeviceRequest& request);
OpenedDevice open_dualshock4(const DeviceRequest& request);

}  // namespace palpa
