// One tick of the 1 kHz servo: reading, clutch, newest contact model, force law, safety, force.
#pragma once
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
    ForceLaw force_law = ConstantForceLaw{};  // the paper's coupling, force held between two steps
    SafetySettings safety = {.is_full = false};
    int delay_ticks = 0;  // between a force and its sending, 0 to max_servo_delay_ticks
    std::optional<GuardedSettings> guarded = {};  // instead of the paper's
    bool is_ending = false;                       // exit was asked for
};

// Everything that one tick leaves to the next.
struct ServoState {
    ServoState() { under_way.fill(Vec3::Zero()); }

    // clutch
    Vec3 handle_m = Vec3::Zero();         // last valid position
    Vec3 travel_m = Vec3::Zero();         // handle travel that the molecule is to follow
    Quat orientation = Quat::Identity();  // last valid one
    Quat turn = Quat::Identity();         // handle turn outside of the clutch
    bool has_reading = false;
    // contact model
    ContactModel contact;  // the newest that came
    bool has_touch = false;
    double model_s = 0;  // when it came, on the servo's clock
    GuardedState guarded;
    // sending
    std::array<Vec3, max_servo_delay_ticks + 1> under_way;  // ring of forces, by tick
    std::uint64_t tick = 0;
    std::uint64_t poses = 0;  // that were posted
    // safety
    SafetyState safety;
    bool was_still = false, was_full = false;
    double heat_share = 1;  // of the last force, see SafetyResult
    // energy observer
    double hand_energy_J = 0;  // work done on the hand so far; + = given to it
};

// What a tick did, for the recording and the overlay.
struct ServoTick {
    DeviceReading reading;
    // The newest; in guarded coupling with place, force, torque, stiffness and displacement gain of
    // this tick.
    ContactModel contact;
    Vec3 sent_newton = Vec3::Zero();  // to be written to the device
    double force_gain = 0;            // F_h/F_m of the force law at this tick
    double hand_energy_J = 0;
    bool clutched = false;
    bool clamped = false;                    // the clamp acted
    bool stopped = false;                    // a force was not finite; latched
    double followed = 1;                     // of the handle's travel, but for clutch and limits
    bool is_safety_full = true;              // the whole chain acted, or the paper's part of it
    SafetyStage stage = SafetyStage::None;   // the gravest that acted
    SafetyStage reason = SafetyStage::None;  // why the force is not back in full
    // Guarded coupling alone.
    double cap_ratio = 1;                     // A_d over the law's, for the cap
    double felt_N_per_m = 0;                  // of the molecule's stiffness, where it is largest
    Mat3 molecule_per_handle = Mat3::Zero();  // travel: 1/A_d, of every direction
    Vec3 damping_newton = Vec3::Zero();       // of the servo's own, in this tick's force
    Vec3 overtravel_m = Vec3::Zero();         // handle travel that the stop holds back
    Vec3 clipped_m = Vec3::Zero();  // that the limits of a step did away with in this tick
};

// Takes the newest contact model out of the exchange, puts the hand's pose in, returns the force
// that the device is to play until the next tick. The force law acts on the norm of the molecular
// force, along its direction. `now_s` is the servo's own monotonic clock. Never throws, locks,
// waits or allocates. `live`: what other hands hold, where it is by now.
[[nodiscard]] ServoTick step_servo(const ServoSettings& settings, ServoState& state,
                                   Exchange& exchange, const DeviceReading& reading, double now_s,
                                   LiveMolecules live = {}) noexcept;

inline constexpr std::size_t most_hands = 4;

// One hand of several, with its own device; its slot is its place in the list.
struct ServoHand {
    ServoSettings settings;
    ServoState state;
    Exchange exchange;
    DeviceReading reading;  // of this tick
    ServoTick tick;         // what it did
};

// One tick of all hands, `most_hands` at most, in their order: each feels what hands before it hold
// where it is in this tick, and what hands after it hold where it was in the last. Never throws,
// locks, waits or allocates.
void step_servos(std::span<ServoHand> hands, double now_s) noexcept;

}  // namespace palpa
