#include "haptics/servo.h"

#include "core/assertion.h"

#include <cstdint>

namespace palpa {
namespace {

// A clutched handle moves, the molecule does not: that travel does not count.
void update_travel(ServoState& state, const DeviceReading& reading) noexcept {
    const bool clutched = is_pressed(reading.buttons, Button::Clutch);
    if (state.has_reading && !clutched) state.travel_m += reading.position_m - state.handle_m;
    state.has_reading = true;
    state.handle_m = reading.position_m;
}

Vec3 law_force(const ForceLaw& law, const Vec3& molecular_newton) noexcept {
    const double norm = molecular_newton.stableNorm();
    if (norm == 0) return Vec3::Zero();
    return molecular_newton * (hand_force(law, norm) / norm);
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

    if (reading.valid && reading.position_m.allFinite()) {
        if (state
                .has_reading) {  // what the last force did while the handle went from there to here
            const std::uint64_t last = state.tick - 1 < delay ? 0 : state.tick - 1 - delay;
            state.hand_energy_J +=
                state.under_way[last % slots].dot(reading.position_m - state.handle_m);
        }
        update_travel(state, reading);
    }

    exchange.touch.read(state.touch);
    exchange.hand.post({reading.time_s, state.travel_m});

    bool clamped = false;
    const Vec3 force = safe_force(settings, state,
                                  law_force(settings.force_law, state.touch.force_newton), clamped);
    state.under_way[state.tick % slots] = force;
    // Before the first force has arrived the device plays it at once rather than nothing.
    const std::uint64_t sent = state.tick < delay ? 0 : state.tick - delay;
    ++state.tick;
    return {reading,
            state.touch,
            state.under_way[sent % slots],
            force_gain(settings.force_law, state.touch.force_newton.stableNorm()),
            state.hand_energy_J,
            is_pressed(reading.buttons, Button::Clutch),
            clamped,
            state.stopped};
}

}  // namespace palpa
