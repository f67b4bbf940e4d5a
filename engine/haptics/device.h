// The interface of a haptic device: limits, readings, force.
#pragma once
#include "math/vec.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

struct ContactModel;

// Servo rate for all devices.
inline constexpr double servo_rate_hz = 1000;
inline constexpr double servo_tick_s = 1 / servo_rate_hz;

// Limits as the maker or the driver states them. SI; axes: x right, y up, z towards the user.
struct DeviceSpec {
    std::string name;
    double rate_hz = servo_rate_hz;      // servo ticks per second
    double peak_force_newton = 0;        // peak force of the motors
    double continuous_force_newton = 0;  // continuous force of the motors; 0 if unknown
    double viscosity_N_s_per_m = 0;      // damping of the device itself; 0 if unknown
    // The largest stiffness that guarded coupling may let the hand feel, if the device states it,
    // N/m; 0: found from the viscosity (haptics/guarded.h).
    double cap_N_per_m = 0;
    // Half size of the box in which the handle can move; 0 along an axis without an end.
    Vec3 half_workspace_m = Vec3::Zero();
    // False for devices that cannot hurt anybody: emulated, or moved by a mouse. The full safety
    // chain guards every real device in every mode.
    bool is_real = true;
    bool shakes = false;  // its motors play the norm of the force, not its direction
};

// A problem that a responding device reports.
enum class DeviceTrouble : std::uint8_t {
    None,
    WarmMotors,   // the motors must cool without force
    ForceRefused  // it exceeded one of its own limits and switched the force off
};

// One reading of the device. `valid` is false if there was no new or no plausible reading.
struct DeviceReading {
    double time_s = 0;               // time on the device's own clock
    Vec3 position_m = Vec3::Zero();  // position of the handle from the centre of the workspace
    std::uint32_t buttons = 0;       // one bit per button, see Button
    bool valid = false;
    Quat orientation = Quat::Identity();  // orientation of the handle, if the device senses it
    DeviceTrouble trouble = DeviceTrouble::None;
    // Whether the handle is at an end of its workspace, if the device knows; see is_at_stop.
    std::optional<bool> at_stop = {};
};

// Whether the reading is valid and all values are finite.
inline bool is_sane(const DeviceReading& reading) noexcept {
    return reading.valid && std::isfinite(reading.time_s) && reading.position_m.allFinite() &&
           reading.orientation.coeffs().allFinite();
}

// Whether the handle is at an end of its workspace: as the device says, else within a millimetre.
inline bool is_at_stop(const DeviceReading& reading, const Vec3& half_workspace_m) noexcept {
    constexpr double near_m = 0.001;
    if (reading.at_stop || !is_sane(reading)) return reading.at_stop.value_or(false);
    for (Eigen::Index i = 0; i < 3; ++i) {
        const double half_m = half_workspace_m(i);
        if (half_m > 0 && std::abs(reading.position_m(i)) >= half_m - near_m) return true;
    }
    return false;
}

enum class Button : std::uint32_t { Clutch = 1 };

inline bool is_pressed(std::uint32_t buttons, Button button) noexcept {
    return (buttons & static_cast<std::uint32_t>(button)) != 0;
}

// A desired velocity, for a virtual handle or for the view. The turn is a rotation vector.
struct HandRate {
    Vec3 m_per_s = Vec3::Zero();
    Vec3 rad_per_s = Vec3::Zero();
};

// Used by the servo thread only, unless stated otherwise. No call waits, locks or allocates.
class Device {
public:
    Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    virtual ~Device() = default;

    virtual const DeviceSpec& spec() const noexcept = 0;
    virtual DeviceReading read() noexcept = 0;

    // Sets the force (N) on the hand until the next write, once per tick. An emulated device runs
    // on the servo's clock and advances by one tick here.
    virtual void write(const Vec3& force_newton) noexcept = 0;

    // Passes what the person sees, every tick before write(): the present contact model, and the
    // handle travel (m) that the molecule has yet to follow.
    virtual void show(const ContactModel& /*contact*/, const Vec3& /*waiting_m*/) noexcept {}

    // What the person must know or do for the device to work, as one sentence with static lifetime;
    // empty if all is well. From any thread.
    virtual std::string_view status() const noexcept { return {}; }

    // Whether the person's input is meant for this program, because its window has the focus;
    // called by the window's thread. A device that works without focus pauses meanwhile. Default:
    // true.
    virtual void attend(bool /*is_meant*/) noexcept {}

    // Desired velocity of the view, as if the scene were in hand: x right, y up, z towards the eye.
    // Called by the window's thread.
    virtual HandRate view_rate() const noexcept { return {}; }
};

}  // namespace palpa
