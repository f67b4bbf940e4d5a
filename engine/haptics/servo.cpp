#include "haptics/servo.h"

#include "core/assertion.h"

#include <cstdint>

namespace palpa {
namespace {

// What the handle did since the last valid reading, clutched or not.
Vec3 take_reading(ServoState& state, const DeviceReading& reading) noexcept {
    if (!reading.valid || !reading.position_m.allFinite()) return Vec3::Zero();
    const Vec3 moved = state.has_reading ? Vec3(reading.position_m - state.handle_m) : Vec3::Zero();
    state.has_reading = true;
    state.handle_m = reading.position_m;
    return moved;
}

// The touch model with what guarded coupling knows of this moment.
TouchModel touch_now(TouchModel touch, const GuardedState& state,
                     const GuardedTick& tick) noexcept {
    if (!state.is_placed || touch.is_still) return touch;
    touch.molecule_angstrom = state.place_angstrom;
    touch.force_newton = tick.force_newton;
    touch.torque_newton_metre = state.at_place.torque_newton_metre;
    touch.displacement_gain = tick.displacement_gain;
    touch.stiffness_matrix_N_per_m = state.at_place.stiffness_N_per_m;
    touch.stiffness_N_per_m = extreme_stiffness(touch.stiffness_matrix_N_per_m);
    return touch;
}

// The last stages before the device. A force that is no number stops the session's forces for good.
Vec3 safe_force(const ServoSettings& settings, ServoState& state, const Vec3& force,
                bool& clamped) noexcept {
    if (!force.allFinite()) {
        state.stopped = true;
        state.under_way.fill(Vec3::Zero());
    }
    if (state.stopped) return Vec3::Zero();
    const double norm = force.norm();
    clamped = norm > settings.clamp_newton;
    return clamped ? Vec3(force * (settings.clamp_newton / norm)) : force;
}

}  // namespace

ServoTick step_servo(const ServoSettings& settings, ServoState& state, Exchange& exchange,
                     const DeviceReading& reading) noexcept {
    PALPA_ASSERT(settings.delay_ticks >= 0 && settings.delay_ticks <= max_servo_delay_ticks);
    constexpr std::uint64_t slots = max_servo_delay_ticks + 1;
    const std::uint64_t delay = static_cast<std::uint64_t>(settings.delay_ticks);

    const Vec3 moved = take_reading(state, reading);
    // What the last force did while the handle went from there to here.
    if (state.tick > 0) {
        const std::uint64_t last = state.tick - 1 < delay ? 0 : state.tick - 1 - delay;
        state.hand_energy_J += state.under_way[last % slots].dot(moved);
    }
    // A clutched handle moves, the molecule does not: that travel does not count.
    const bool clutched = is_pressed(reading.buttons, Button::Clutch);
    if (!clutched) state.travel_m += moved;

    const bool is_new = exchange.touch.take();
    const Touch& touch = exchange.touch.taken();
    if (is_new) state.touch = touch.model;
    ServoTick tick;
    tick.reading = reading;
    tick.clutched = clutched;
    HandPose pose{reading.time_s, state.travel_m};
    Vec3 wanted = Vec3::Zero();
    if (settings.guarded) {
        if (is_new) take_touch(touch, state.guarded);
        const GuardedTick done =
            step_guarded(*settings.guarded, touch, state.handle_m, moved, clutched, state.guarded);
        wanted = done.hand_newton;
        tick.felt_N_per_m = done.felt_N_per_m;
        tick.dropped_m = done.dropped_m;
        tick.kept_m = state.guarded.kept_m;
        tick.touch = touch_now(state.touch, state.guarded, done);
        if (state.guarded.is_placed) pose.place_angstrom = state.guarded.place_angstrom;
    } else {
        state.guarded = {};
        wanted = hand_force(settings.force_law, state.touch.force_newton);
        tick.touch = state.touch;
    }
    exchange.hand.post(pose);

    const Vec3 force = safe_force(settings, state, wanted, tick.clamped);
    state.under_way[state.tick % slots] = force;
    // Before the first force has arrived the device plays it at once rather than nothing.
    const std::uint64_t sent = state.tick < delay ? 0 : state.tick - delay;
    ++state.tick;
    tick.sent_newton = state.under_way[sent % slots];
    const ForceLaw& law = settings.guarded ? settings.guarded->force_law : settings.force_law;
    tick.force_gain = force_gain(law, tick.touch.force_newton.norm());
    tick.hand_energy_J = state.hand_energy_J;
    tick.stopped = state.stopped;
    return tick;
}

}  // namespace palpa
