#include "haptics/servo.h"

#include "core/assertion.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace palpa {
namespace {

// What the handle did since the last valid reading, clutched or not.
HandleStep take_reading(ServoState& state, const DeviceReading& reading) noexcept {
    if (!is_sane(reading)) return {};
    HandleStep step;
    if (state.has_reading) {
        step.moved_m = reading.position_m - state.handle_m;
        step.turned = reading.orientation * state.orientation.conjugate();
    }
    state.has_reading = true;
    state.handle_m = reading.position_m;
    state.orientation = reading.orientation;
    return step;
}

// The contact model with what guarded coupling knows of this moment.
ContactModel touch_now(ContactModel contact, const GuardedState& state,
                       const GuardedTick& tick) noexcept {
    if (!state.is_placed || contact.is_still) return contact;
    contact.molecule = state.molecule;
    contact.force_newton = tick.force_newton;
    contact.torque_newton_metre = state.at_place.torque_newton_metre;
    contact.displacement_gain = tick.displacement_gain;
    contact.stiffness_matrix_N_per_m = state.at_place.stiffness_N_per_m;
    contact.stiffness_N_per_m = extreme_stiffness(contact.stiffness_matrix_N_per_m);
    return contact;
}

// The force that left `delay` ticks ago; before the first has arrived that at once rather than
// nothing. What is no number does not wait.
Vec3 delayed(const ServoSettings& settings, ServoState& state, const Vec3& wanted) noexcept {
    constexpr std::uint64_t slots = max_servo_delay_ticks + 1;
    const std::uint64_t delay = static_cast<std::uint64_t>(settings.delay_ticks);
    state.under_way[state.tick % slots] = wanted;
    const std::uint64_t sent = state.tick < delay ? 0 : state.tick - delay;
    ++state.tick;
    return wanted.allFinite() ? state.under_way[sent % slots] : wanted;
}

// A hand that had no hold takes hold anew, quietly.
void follow_stillness(const ContactModel& contact, ServoState& state) noexcept {
    if (contact.is_still == state.was_still) return;
    state.was_still = contact.is_still;
    contact.is_still ? disengage(state.safety) : engage(state.safety);
}

// The chain that begins to watch knows nothing of before; what is felt goes on.
void follow_safety(const SafetySettings& settings, ServoState& state) noexcept {
    if (settings.is_full && !state.was_full && state.tick > 0) {
        SafetyState fresh;
        fresh.not_finite = state.safety.not_finite;
        fresh.sent_newton = state.safety.sent_newton;
        fresh.engagement = SafetyState::Engagement::On;
        fresh.risen = 1;
        state.safety = fresh;
    }
    state.was_full = settings.is_full;
}

// What the hand holds, where guarded coupling has put it.
std::optional<LiveMolecule> live_molecule(const ServoState& state) noexcept {
    const GuardedState& guarded = state.guarded;
    if (!guarded.is_placed) return {};
    return LiveMolecule{guarded.molecule, guarded.grip_number};
}

// With the contact model that was taken last; `is_new`: for this tick.
ServoTick step_with_taken(const ServoSettings& settings, ServoState& state, Exchange& exchange,
                          bool is_new, const DeviceReading& reading, double now_s,
                          LiveMolecules live) noexcept {
    PALPA_ASSERT(settings.delay_ticks >= 0 && settings.delay_ticks <= max_servo_delay_ticks);
    follow_safety(settings.safety, state);
    HandleStep handle = take_reading(state, reading);
    handle.followed = state.heat_share;
    // What the last force did while the handle went from there to here.
    state.hand_energy_J += state.safety.sent_newton.dot(handle.moved_m);
    // A clutched handle moves, the molecule does not: that travel does not count.
    const bool clutched = is_pressed(reading.buttons, Button::Clutch);
    if (!clutched) {
        state.travel_m += handle.followed * handle.moved_m;
        state.turn = (handle.turned * state.turn).normalized();
    }

    const LocalContactModel& contact = exchange.contact.taken();
    if (is_new) state.contact = contact.model;
    follow_stillness(state.contact, state);
    state.has_touch = state.has_touch || is_new;
    // A clock that goes back makes no model younger.
    if (is_new || !state.has_touch || now_s < state.model_s) state.model_s = now_s;

    ServoTick tick;
    tick.reading = reading;
    tick.clutched = clutched;
    tick.is_at_stop = is_at_stop(reading, settings.half_workspace_m);
    tick.contact = state.contact;
    HandPose pose{reading.time_s, state.travel_m, state.turn};
    pose.is_clutched = clutched;
    Vec3 wanted = Vec3::Zero();
    if (settings.guarded) {
        GuardedState& guarded = state.guarded;
        if (is_new || (state.has_touch && !guarded.is_placed))
            take_local_contact(*settings.guarded, contact, guarded, live);
        const GuardedTick done = step_guarded(*settings.guarded, contact, state.handle_m, handle,
                                              clutched, guarded, live);
        wanted = done.hand_newton;
        tick.cap_ratio = done.cap_ratio;
        tick.felt_N_per_m = done.felt_N_per_m;
        tick.molecule_per_handle = done.molecule_per_handle;
        tick.damping_newton = done.damping_newton;
        tick.clipped_m = done.clipped_m;
        tick.overtravel_m = guarded.overtravel_m;
        tick.waiting_m = guarded.waiting_m;
        tick.cap_N_per_m = settings.guarded->device_cap_N_per_m;
        tick.contact = touch_now(state.contact, guarded, done);
        if (guarded.is_placed) {
            pose.molecule = guarded.molecule;
            pose.grip_number = guarded.grip_number;
        }
    } else {
        const Vec3 velocity = filtered_velocity(state.guarded.handle_m_per_s, handle.moved_m);
        state.guarded = {};
        state.guarded.handle_m_per_s = velocity;
        wanted = hand_force(settings.force_law, state.contact.force_newton);
    }
    pose.number = ++state.poses;
    exchange.hand.post(pose);

    const SafetyResult safe =
        guard_force(settings.safety, state.safety,
                    {delayed(settings, state, wanted), reading, now_s, now_s - state.model_s,
                     state.contact.period_s, state.guarded.handle_m_per_s, settings.is_ending});
    tick.sent_newton = safe.newton;
    tick.stage = safe.stage;
    tick.reason = safe.reason;
    tick.stopped = is_latched(state.safety);
    state.heat_share = safe.heat_share;
    tick.followed = handle.followed;
    tick.is_safety_full = settings.safety.is_full;
    tick.clamped = safe.stage == SafetyStage::Clamped;
    const ForceLaw& law = settings.guarded ? settings.guarded->force_law : settings.force_law;
    tick.force_gain = force_gain(law, tick.contact.force_newton.norm());
    tick.hand_energy_J = state.hand_energy_J;
    return tick;
}

}  // namespace

ServoTick step_servo(const ServoSettings& settings, ServoState& state, Exchange& exchange,
                     const DeviceReading& reading, double now_s, LiveMolecules live) noexcept {
    const bool is_new = exchange.contact.take();
    return step_with_taken(settings, state, exchange, is_new, reading, now_s, live);
}

void step_servos(std::span<ServoHand> hands, double now_s) noexcept {
    PALPA_ASSERT(hands.size() <= most_hands);
    std::array<std::optional<LiveMolecule>, most_hands> live;
    // Before any hand posts its pose: no hand may feel what the simulation found from poses of this
    // tick, or the tick could not be played again.
    std::array<bool, most_hands> is_new{};
    for (std::size_t i = 0; i < hands.size(); ++i) {
        is_new[i] = hands[i].exchange.contact.take();
        live[i] = live_molecule(hands[i].state);
    }
    for (std::size_t i = 0; i < hands.size(); ++i) {
        ServoHand& hand = hands[i];
        hand.tick = step_with_taken(hand.settings, hand.state, hand.exchange, is_new[i],
                                    hand.reading, now_s, std::span(live).first(hands.size()));
        live[i] = live_molecule(hand.state);
    }
}

}  // namespace palpa
