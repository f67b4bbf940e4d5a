// A joystick or wheel with motors, of USB's class of physical interface devices (PID): its stick is
// the handle, right and left by X, up and down by Y (away from the person is up, as with a mouse);
// towards the person it does not go. The first button is the clutch. On Linux alone: the other
// systems give no report descriptor to hidapi 0.13.
//
// The device plays effects. One constant force for each axis is created, set and started when it
// is opened, with a direction that it keeps, and from then on only magnitudes are sent: a report
// for each axis that changed. One effect for both axes would take two reports for every force,
// magnitude and direction, between which the force is wrong.
//
// "Device Class Definition for Physical Interface Devices (PID)" 1.0 and "HID Usage Tables", page
// 0x0F, both of the USB-IF; what to put into fields that they leave open as Linux's hid-pidff does,
// which drives such devices. Directions are where a force comes from, clockwise from away from the
// person, as a SideWinder Force Feedback 2 was reported to play them. Nothing was tried on
// hardware.
#pragma once
#include "devices/hid_descriptor.h"
#include "devices/hid_device.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

class ForceJoystickProtocol final : public HidProtocol {
public:
    // From the middle to the end of the stick's travel, at the grip, m. Assumed, because no device
    // reports it.
    static constexpr double half_travel_m = 0.050;
    // Force at the largest magnitude, N. Assumed likewise.
    static constexpr double peak_newton = HidDevice::full_newton;

    std::string_view name() const noexcept override { return "force-feedback joystick"; }
    bool is_ours(const HidPlace& place) const noexcept override;
    std::string why_not(const HidPlace& place) const override;
    void describe(DeviceSpec& spec) const noexcept override;
    bool is_talkative() const noexcept override { return false; }
    DeviceCheck begin(HidLine& line, const HidPlace& place) noexcept override;
    void end(HidLine& line) noexcept override;
    bool decode(HidBytes report, HidInput& input) noexcept override;
    HidBytes encode(const HidOutput& output) noexcept override;
    HidBytes encode_next() noexcept override;
    void forget() noexcept override;
    double least_s() const noexcept override { return 0.002; }

    // Reads the report descriptor of the device. Returns what a force needs and the descriptor
    // lacks; empty if the device can be used.
    std::string use(HidBytes descriptor);

private:
    // One axis with a force.
    struct Axis {
        HidField place;        // field of an input report
        double direction_deg;  // direction from which a positive magnitude pushes
        int index;             // index of the handle's axis
        double sign;           // sign of the stick's axis on it
        std::int64_t block = 0;
        std::optional<std::int64_t> magnitude = 0;  // last magnitude sent
        std::vector<std::uint8_t> report = {};      // report that sets the magnitude
    };
    enum class Loaded { Yes, Full, No };

    void find_axes();
    bool control(HidLine& line, HidUsage command) const;
    bool operate(HidLine& line, const Axis& axis, HidUsage operation) const;
    Loaded create(HidLine& line, Axis& axis) const;
    Loaded load(HidLine& line, std::int64_t& block) const;
    bool start(HidLine& line, Axis& axis) const;
    DeviceCheck start_all(HidLine& line);

    HidDescriptor descriptor_;
    std::vector<Axis> axes_;  // axes with an effect, after begin()
    HidField magnitude_;
    std::optional<HidField> button_;
    Vec3 wanted_newton_ = Vec3::Zero();
};

// For the list of devices.
OpenedDevice open_force_joystick(const DeviceRequest& request);

}  // namespace palpa
