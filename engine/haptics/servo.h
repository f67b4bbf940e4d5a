// One tick of the 1 kHz servo: reading, clutch, contact model, force law, safety, force.
#pragma once
#include "core/hands.h"
#include "haptics/device.h"
#include "haptics/exchange.h"
#include "haptics/gains.h"
#include "haptics/guarded.h"
#include "haptics/safety.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace palpa {

inline constexpr int max_servo_delay_ticks = 7;

struct ServoSettings {
    ForceLaw force_law = ConstantForceLaw{};  // force law of the paper's modes
    SafetySettings safety = {.is_full = false};
    int delay_ticks = 0;  // delay between computing and sending a force, 0 to max_servo_delay_ticks
    std::optional<GuardedSettings> guarded = {};  // guarded coupling; unset for the paper's modes
    bool is_ending = false;                       // the program is ending
    Vec3 half_workspace_m = Vec3::Zero();         // of the device
};

// The state between two ticks.
struct ServoState {
    ServoState() { under_way.fill(Vec3::Zero()); }

    // clutch
    Vec3 handle_m = Vec3::Zero();         // last valid handle position
    Vec3 travel_m = Vec3::Zero();         // handle travel for the molecule
    Quat orientation = Quat::Identity();  // last valid orientation
    Quat turn = Quat::Identity();         // handle turn without clutched motion
    bool has_reading = false;
    // contact model
    ContactModel contact;  // newest contact model
    bool has_touch = false;
    double model_s = 0;  // time of its arrival on the servo's clock
    GuardedState guarded;
    // sending
    std::array<Vec3, max_servo_delay_ticks + 1> under_way;  // ring of forces not yet sent, by tick
    std::uint64_t tick = 0;
    std::uint64_t poses = 0;  // number of posted poses
    // safety
    SafetyState safety;
    bool was_still = false, was_full = false;
    double heat_share = 1;  // of the last force, see SafetyResult
    // energy observer
    double hand_energy_J = 0;  // work on the hand so far; + = given to it
};

// The result of a tick, for recording and window.
struct ServoTick {
    DeviceReading reading;
    // The newest; in guarded coupling with place, force, torque, stiffness and displacement gain of
    // this tick.
    ContactModel contact;
    Vec3 sent_newton = Vec3::Zero();  // force for the device
    double force_gain = 0;            // gain F_h/F_m of the force law at this tick
    double hand_energy_J = 0;
    bool clutched = false;
    bool clamped = false;     // whether the force was clipped
    bool stopped = false;     // a force was not finite; stays set
    bool is_at_stop = false;  // the handle is at an end of its workspace
    double followed =
        1;  // share of the handle's travel that the molecule followed, without clutch and limits
    bool is_safety_full = true;              // whether the full safety chain acted
    SafetyStage stage = SafetyStage::None;   // most severe stage
    SafetyStage reason = SafetyStage::None;  // why the force has not fully returned
    // The following fields are for guarded coupling only.
    double cap_ratio = 1;     // cap ratio: A_d divided by that of the law
    double felt_N_per_m = 0;  // largest stiffness felt, N/m
    Mat3 molecule_per_handle =
        Mat3::Zero();  // molecule travel per handle travel: inverse of A_d as a tensor
    Vec3 damping_newton = Vec3::Zero();  // damping force of the servo in this tick
    Vec3 overtravel_m = Vec3::Zero();    // overtravel of the handle at the stop
    Vec3 waiting_m = Vec3::Zero();       // handle travel that waits for the contact model
    Vec3 clipped_m = Vec3::Zero();       // clipped travel in this tick
    double cap_N_per_m = 0;              // the device's stiffness cap
};

// Takes the newest contact model out of the exchange, puts the hand's pose in, returns the force
// that the device is to play until the next tick. The force law acts on the norm of the molecular
// force, along its direction. `now_s` is the servo's own monotonic clock. Never throws, locks,
// waits or allocates. `live`: what other hands hold, where it is by now.
[[nodiscard]] ServoTick step_servo(const ServoSettings& settings, ServoState& state,
                                   Exchange& exchange, const DeviceReading& reading, double now_s,
                                   LiveMolecules live = {}) noexcept;

// One hand of several, with its own device; its slot is its place in the list.
struct ServoHand {
    ServoSettings settings;
    ServoState state;
    Exchange exchange;
    DeviceReading reading;  // reading of this tick
    ServoTick tick;         // result of this tick
};

// One tick of all hands, `most_hands` at most, in their order: each feels what hands before it hold
// where it is in this tick, and what hands after it hold where it was in the last. Never throws,
// locks, waits or allocates.
void step_servos(std::span<ServoHand> hands, double now_s) noexcept;

}  // namespace palpa
