// What a haptic device is to the rest of the program: limits, a reading, a force.
#pragma once
#include "math/vec.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpa {

struct ContactModel;

// The servo ticks this often, on every device so far.
inline constexpr double servo_rate_hz = 1000;
inline constexpr double servo_tick_s = 1 / servo_rate_hz;

// Limits as the maker or the driver states them. SI; axes: x right, y up, z towards the user.
struct DeviceSpec {
    std::string name;
    double rate_hz = servo_rate_hz;      // servo ticks a second
    double peak_force_newton = 0;        // what the motors give at most
    double continuous_force_newton = 0;  // what they give for ever; 0 if not known
    double viscosity_N_s_per_m = 0;      // what is known of the device's own damping; 0 if nothing
    Vec3 half_workspace_m = Vec3::Zero();  // the box in which the handle can move, from its centre
    // False where nothing can hurt anybody: emulated, or led by a mouse. The whole safety chain
    // guards every real device, whatever the mode.
    bool is_real = true;
};

// What a device that still answers says of its motors.
enum class DeviceTrouble : std::uint8_t {
    None,
    WarmMotors,   // it has to rest without force
    ForceRefused  // one of its own limits was passed, and it let go
};

// One look at the device. `valid` is false if the device had nothing new or nothing sane to say.
struct DeviceReading {
    double time_s = 0;               // on the device's own clock
    Vec3 position_m = Vec3::Zero();  // of the handle, from the centre of the workspace
    std::uint32_t buttons = 0;       // one bit a button, see Button
    bool valid = false;
    Quat orientation = Quat::Identity();  // of the handle, where the device senses it
    DeviceTrouble trouble = DeviceTrouble::None;
};

// Valid, and every value a number.
inline bool is_sane(const DeviceReading& reading) noexcept {
    return reading.valid && std::isfinite(reading.time_s) && reading.position_m.allFinite() &&
           reading.orientation.coeffs().allFinite();
}

enum class Button : std::uint32_t { Clutch = 1 };

inline bool is_pressed(std::uint32_t buttons, Button button) noexcept {
    return (buttons & static_cast<std::uint32_t>(button)) != 0;
}

// How fast a hand wants something to go that goes on by itself: a handle that is not there, or
// what is seen. The turn is a rotation vector.
struct HandRate {
    Vec3 m_per_s = Vec3::Zero();
    Vec3 rad_per_s = Vec3::Zero();
};

// Used by one thread, the servo's, unless said otherwise. No call waits, locks or allocates.
class Device {
public:
    Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    virtual ~Device() = default;

    virtual const DeviceSpec& spec() const noexcept = 0;
    virtual DeviceReading read() noexcept = 0;

    // The force (N) on the hand, held until the next write: one write a tick. An emulated device
    // lives on the servo's clock and moves on by one tick here.
    virtual void write(const Vec3& force_newton) noexcept = 0;

    // What the person at it sees of the molecule: in every tick, before the force is written.
    virtual void show(const ContactModel& /*contact*/) noexcept {}

    // What the person has to know or do for the device to work, one sentence, which is never freed;
    // empty where all is well. From any thread.
    virtual std::string_view status() const noexcept { return {}; }

    // Whether the person at it means this program, as its window has the focus; by the window's
    // thread. A device that is heard without focus too rests meanwhile. Unless told otherwise, yes.
    virtual void attend(bool /*is_meant*/) noexcept {}

    // How fast the person wants to move what is seen, as if it were in hand: x right, y up, z
    // towards the eye. By the window's thread.
    virtual HandRate view_rate() const noexcept { return {}; }
};

}  // namespace palpa
