// One tick of the 1 kHz servo: reading, clutch, newest touch model, force law, safety, force.
#pragma once
#include "haptics/device.h"
#include "haptics/exchange.h"
#include "haptics/gains.h"
#include "math/vec.h"

#include <array>
#include <cstdint>

namespace palpa {

inline constexpr int max_servo_delay_ticks = 7;

struct ServoSettings {
    ForceLaw force_law = ConstantForceLaw{};
    double clamp_newton = 3.0;  // on the norm of the force
    int delay_ticks = 0;        // between a force and its sending, 0 to max_servo_delay_ticks
};

// Everything that one tick leaves to the next.
struct ServoState {
    // clutch
    Vec3 handle_m = Vec3::Zero();  // last valid position
    Vec3 travel_m = Vec3::Zero();  // handle travel outside of the clutch
    bool has_reading = false;
    // touch model
    TouchModel touch;  // the newest that came
    // safety
    bool stopped = false;  // a force was not finite; latched
    // sending
    std::array<Vec3, max_servo_delay_ticks + 1> under_way{};  // ring of forces, by tick
    std::uint64_t tick = 0;
    // energy observer
    double hand_energy_J = 0;  // work done on the hand so far; + = given to it
};

// What a tick did, for the recording and the overlay.
struct ServoTick {
    DeviceReading reading;
    TouchModel touch;
    Vec3 sent_newton = Vec3::Zero();  // to be written to the device
    double force_gain = 0;            // F_h/F_m of the force law at this tick
    double hand_energy_J = 0;
    bool clutched = false;
    bool clamped = false;  // the clamp acted
    bool stopped = false;
};

// Takes the newest touch model out of the exchange, puts the hand's pose in, returns the force that
// the device is to play until the next tick. Eq. 2 acts on the norm of the molecular force, along
// its direction. Never throws, locks, waits or allocates.
[[nodiscard]] ServoTick step_servo(const ServoSettings& settings, ServoState& state,
                                   Exchange& exchange, const DeviceReading& reading) noexcept;

}  // namespace palpa
