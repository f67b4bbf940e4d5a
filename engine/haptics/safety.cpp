#include "haptics/safety.h"

#include "core/repeatable.h"
#include "core/translate.h"

#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

using Engagement = SafetyState::Engagement;

constexpr double shortest_tick_s = servo_tick_s / 10;  // less is no time for a tick
constexpr double rounding_s = 1e-6;                    // of a sum of ticks

struct Elapsed {
    // Since the last tick, bounded both ways so that every watch below goes on.
    double s = servo_tick_s;
    SafetyStage fault = SafetyStage::None;
};

Elapsed update_clock(const SafetySettings& settings, SafetyState& state, double now_s) noexcept {
    if (!std::isfinite(now_s)) {
        state.has_clock = false;
        return {servo_tick_s, SafetyStage::Late};
    }
    const double elapsed_s = state.has_clock ? now_s - state.last_s : servo_tick_s;
    state.has_clock = true;
    state.last_s = now_s;
    if (elapsed_s < 0) return {servo_tick_s, SafetyStage::Late};
    const double late_s = settings.late_s - rounding_s;
    if (elapsed_s < shortest_tick_s) {
        state.stood_s += servo_tick_s;
        return {shortest_tick_s, state.stood_s > late_s ? SafetyStage::Late : SafetyStage::None};
    }
    state.stood_s = 0;
    if (elapsed_s > late_s) return {settings.late_s, SafetyStage::Late};
    return {elapsed_s};
}

// Whether ticks are slow on average, none of them being late by itself.
bool update_pace(SafetyState& state, double elapsed_s) noexcept {
    const auto elapsed_us = static_cast<std::uint32_t>(std::lround(1e6 * elapsed_s));
    std::uint32_t& oldest_us = state.ticks_us[state.next_tick];
    state.ticks_sum_us += elapsed_us - oldest_us;
    oldest_us = elapsed_us;
    state.next_tick = (state.next_tick + 1) % slow_window_ticks;
    return state.ticks_sum_us > slow_window_us;
}

// Both watches run on once they have run out, until the reading changes.
bool update_frozen(const SafetySettings& settings, SafetyState& state, bool has_moved,
                   double stamp_s, double elapsed_s) noexcept {
    const bool stamp_moved = stamp_s != state.stamp_s;
    state.stamp_s = stamp_s;
    state.stamp_runs = state.stamp_runs || stamp_moved;
    if (has_moved || stamp_moved) {
        state.hung_newton = state.sent_newton;
        state.hung_changed = false;
        state.hung_s = 0;
    } else {
        state.hung_changed = state.hung_changed || state.sent_newton != state.hung_newton;
        state.hung_s += elapsed_s;
    }
    const double limit_s = settings.frozen_s - rounding_s;
    if (has_moved) {
        state.still_s = state.pushed_s = 0;
    } else if (state.still_s < limit_s) {
        state.still_s += elapsed_s;
        const Vec3 change = state.sent_newton - state.still_newton;
        state.still_newton += change * (elapsed_s / state.still_s);
    } else if (state.pushed_s < limit_s) {
        const double change = (state.sent_newton - state.still_newton).norm();
        constexpr double makes_up = 0.25;
        state.pushed_s += change > settings.frozen_newton ? elapsed_s : -makes_up * elapsed_s;
        state.pushed_s = std::max(state.pushed_s, 0.0);
    }
    const bool is_hung = state.stamp_runs && state.hung_changed && state.hung_s >= limit_s;
    return is_hung || state.pushed_s >= limit_s;
}

SafetyStage update_reading(const SafetySettings& settings, SafetyState& state,
                           const DeviceReading& reading, double elapsed_s) noexcept {
    state.unread_s += elapsed_s;
    if (!is_sane(reading)) {
        if (state.unread_s < settings.gone_s - rounding_s) return SafetyStage::None;
        state.has_reading = false;
        return SafetyStage::Unplugged;
    }
    if (!state.has_reading) {
        state.has_reading = true;
        state.unread_s = 0;
        state.handle_m = reading.position_m;
        state.stamp_s = reading.time_s;
        state.stamp_runs = false;
        state.hung_newton = state.sent_newton;
        state.hung_changed = false;
        state.hung_s = state.still_s = state.pushed_s = 0;
        return SafetyStage::None;
    }
    const double way_m = (reading.position_m - state.handle_m).norm();
    const double ticks = std::max(1.0, state.unread_s / servo_tick_s);
    state.unread_s = 0;
    state.handle_m = reading.position_m;
    const bool is_frozen = update_frozen(settings, state, way_m != 0, reading.time_s, elapsed_s);
    if (way_m > settings.farthest_jump_m * ticks) return SafetyStage::Jump;
    return is_frozen ? SafetyStage::Frozen : SafetyStage::None;
}

// A model that comes back before all has faded brings the force back as quickly as it went.
void update_stale(const SafetySettings& settings, SafetyState& state, const SafetyInput& input,
                  double elapsed_s) noexcept {
    const double period_s = std::isfinite(input.period_s) ? input.period_s : 0;
    const double stale_s = std::max(settings.stale_periods * period_s, settings.stale_s);
    const double dead_s = std::max(settings.dead_periods * period_s, settings.dead_s);
    const bool fades = !(input.model_age_s <= stale_s);  // no number: it fades
    const double change = elapsed_s / (dead_s - stale_s);
    state.faded = std::clamp(state.faded + (fades ? change : -change), 0.0, 1.0);
    if (state.faded > 1 - rounding_s || input.model_age_s > dead_s - rounding_s) state.faded = 1;
}

// What motors report that are warmer than our own forces explain.
void update_cool_down(const SafetySettings& settings, SafetyState& state, DeviceTrouble trouble,
                      double elapsed_s) noexcept {
    const bool is_warm = trouble == DeviceTrouble::WarmMotors;
    const double change = elapsed_s / settings.cool_down_s;
    state.cool_down_share =
        std::clamp(state.cool_down_share + (is_warm ? change : -change), 0.0, 1.0);
    if (state.cool_down_share > 1 - rounding_s) state.cool_down_share = 1;
    const double hot = settings.thermal_limit_newton * settings.thermal_limit_newton;
    if (is_warm) state.mean_square_newton2 = std::max(state.mean_square_newton2, hot);
}

// The share of the force that the end leaves.
double update_ending(const SafetySettings& settings, SafetyState& state, bool is_ending,
                     double elapsed_s) noexcept {
    state.ending_s = is_ending ? state.ending_s + elapsed_s : 0;
    if (state.ending_s >= settings.ending_s - rounding_s) return 0;
    return 1 - state.ending_s / settings.ending_s;
}

// The clamp (N) that the heat of what was sent so far leaves.
double update_heat(const SafetySettings& settings, SafetyState& state, double elapsed_s) noexcept {
    state.mean_square_newton2 += (state.sent_newton.squaredNorm() - state.mean_square_newton2) *
                                 -repeatable::expm1(-elapsed_s / settings.heat_s);
    const double hot = settings.thermal_limit_newton * settings.thermal_limit_newton;
    const double lowest = std::min(settings.thermal_limit_newton, settings.clamp_newton);
    if (!state.is_thermally_limited && state.mean_square_newton2 >= hot) {
        state.is_thermally_limited = true;
        state.glided = 0;
        state.limited_from_newton =
            std::clamp(state.sent_newton.norm(), lowest, settings.clamp_newton);
    }
    if (state.mean_square_newton2 < settings.cooled_share * hot) state.is_thermally_limited = false;
    const double change = elapsed_s / settings.glide_s;
    state.glided =
        std::clamp(state.glided + (state.is_thermally_limited ? change : -change), 0.0, 1.0);
    const double highest = state.is_thermally_limited
                               ? std::min(state.limited_from_newton, settings.clamp_newton)
                               : settings.clamp_newton;
    return highest - state.glided * (std::max(highest, lowest) - lowest);
}

// Clock and reading begin anew.
void forget(SafetyState& state) noexcept {
    state.has_clock = state.has_reading = false;
    state.stood_s = 0;
}

void stop(SafetyState& state, SafetyStage fault) noexcept {
    if (state.engagement != Engagement::Off) state.engagement = Engagement::Waiting;
    state.quiet_cycles = 0;
    state.risen = 0;
    state.reason = std::max(state.reason, fault);
}

SafetyStage update_engagement(const SafetySettings& settings, SafetyState& state,
                              const Vec3& wanted_newton, double elapsed_s) noexcept {
    if (state.engagement == Engagement::Off) return SafetyStage::Disengaged;
    if (state.engagement == Engagement::Waiting) {
        const bool is_quiet = wanted_newton.norm() < settings.quiet_newton;
        state.quiet_cycles = is_quiet ? state.quiet_cycles + 1 : 0;
        if (state.quiet_cycles <= settings.quiet_cycles) return SafetyStage::Waiting;
        state.engagement = Engagement::Rising;
    }
    if (state.engagement == Engagement::Rising) {
        state.risen += elapsed_s / settings.ramp_s;
        if (state.risen < 1 - rounding_s) return SafetyStage::Engaging;
        state.risen = 1;
        state.engagement = Engagement::On;
        state.reason = SafetyStage::None;
    }
    return SafetyStage::None;
}

Vec3 clamped(const Vec3& force, double clamp_newton, double& share) noexcept {
    const double norm = force.norm();
    if (norm <= clamp_newton) return force;
    share *= clamp_newton / norm;
    return force * (clamp_newton / norm);
}

Vec3 slewed(const SafetySettings& settings, const Vec3& from, const Vec3& to, double elapsed_s,
            SafetyStage& stage) noexcept {
    const double farthest = settings.slew_newton_per_s * std::min(elapsed_s, servo_tick_s);
    const Vec3 change = to - from;
    const double norm = change.norm();
    if (norm <= farthest) return to;
    stage = std::max(stage, SafetyStage::Slewed);
    return from + change * (farthest / norm);
}

SafetyResult guard_papers_force(const SafetySettings& settings, SafetyState& state,
                                const Vec3& wanted_newton) noexcept {
    SafetyResult result;
    if (state.not_finite) {
        result.stage = SafetyStage::NotFinite;
        result.share = 0;
    } else {
        result.newton = clamped(wanted_newton, settings.clamp_newton, result.share);
        if (result.share < 1) result.stage = SafetyStage::Clamped;
    }
    state.sent_newton = result.newton;
    return result;
}

}  // namespace

SafetyState::SafetyState() noexcept {
    ticks_us.fill(static_cast<std::uint32_t>(std::lround(1e6 * servo_tick_s)));
    for (const std::uint32_t tick_us : ticks_us) ticks_sum_us += tick_us;
}

bool supports_period(const DeviceSpec& device, double period_s) noexcept {
    const bool gives_force = device.is_real && device.peak_force_newton > 0;
    return !gives_force || period_s <= longest_real_period_s;
}

void limit_to(const DeviceSpec& device, SafetySettings& settings) noexcept {
    if (device.peak_force_newton > 0) {
        settings.clamp_newton = std::min(settings.clamp_newton, device.peak_force_newton);
    } else {
        constexpr double never = std::numeric_limits<double>::infinity();
        settings.frozen_s = settings.frozen_newton = settings.thermal_limit_newton = never;
    }
    if (device.continuous_force_newton > 0)
        settings.thermal_limit_newton = device.continuous_force_newton;
}

std::string_view describe(SafetyStage stage) noexcept {
    switch (stage) {
        case SafetyStage::None:
            return "";
        case SafetyStage::Slewed:
            return for_translation(
                "The force changes faster than the device allows, so it is sent a little more "
                "slowly.");
        case SafetyStage::Clamped:
            return for_translation(
                "The force is at the limit of the device (clipping): push less, or choose a "
                "smaller force gain.");
        case SafetyStage::ThermalLimit:
            return for_translation(
                "The motors are warm, so the force is reduced (thermal limit): let them cool for a "
                "while.");
        case SafetyStage::Engaging:
            return for_translation(
                "The force is coming back: hold the handle. It reaches its full value in two "
                "seconds.");
        case SafetyStage::Waiting:
            return for_translation(
                "The force is off: move the molecule to a place without force, then the force "
                "returns.");
        case SafetyStage::Disengaged:
            return for_translation(
                "The force is off while the scene is paused: continue, and it returns.");
        case SafetyStage::Ending:
            return for_translation("The program ends and the force fades: hold the handle.");
        case SafetyStage::Stale:
            return for_translation(
                "The simulation is too slow or has stopped, so the force fades: wait, or reduce "
                "the number of active joints.");
        case SafetyStage::CoolDown:
            return for_translation(
                "The device reports that its motors are too warm, so the force fades: let them "
                "cool until it returns.");
        case SafetyStage::TooFast:
            return for_translation(
                "The handle moved faster than its limit, so the force is off: move it slowly.");
        case SafetyStage::Late:
            return for_translation(
                "The force loop was late (servo tick missed), so the force is off: close other "
                "programs.");
        case SafetyStage::Frozen:
            return for_translation(
                "The device reports no motion although the force changes, so the force is off: "
                "move the handle, or plug the device in again.");
        case SafetyStage::Jump:
            return for_translation(
                "The handle's position jumped, so the force is off: check the cable and "
                "calibrate the device.");
        case SafetyStage::Refused:
            return for_translation(
                "The device switched off a force that was too large or too sudden: move the handle "
                "slowly, then the force returns.");
        case SafetyStage::Unplugged:
            return for_translation(
                "The device does not answer, so the force is off: check cable and power.");
        case SafetyStage::NotFinite:
            return for_translation(
                "The computed force was not a number, so the force stays off: reset the scene "
                "(R).");
    }
    return "";
}

SafetyResult guard_force(const SafetySettings& settings, SafetyState& state,
                         const SafetyInput& input) noexcept {
    if (!input.wanted_newton.allFinite()) state.not_finite = true;
    if (!settings.is_full) return guard_papers_force(settings, state, input.wanted_newton);

    // what is wrong
    if (state.engagement == Engagement::Off) forget(state);
    const Elapsed elapsed = update_clock(settings, state, input.now_s);
    update_cool_down(settings, state, input.reading.trouble, elapsed.s);
    const double clamp_newton = update_heat(settings, state, elapsed.s);
    update_stale(settings, state, input, elapsed.s);
    const double ending_share = update_ending(settings, state, input.is_ending, elapsed.s);
    SafetyStage fault = elapsed.fault;
    if (update_pace(state, elapsed.s)) fault = std::max(fault, SafetyStage::Late);
    fault = std::max(fault, update_reading(settings, state, input.reading, elapsed.s));
    if (!(input.velocity_m_per_s.norm() <= settings.fastest_m_per_s)) {  // no number: too fast
        fault = std::max(fault, SafetyStage::TooFast);
    }
    if (input.reading.trouble == DeviceTrouble::ForceRefused) {
        fault = std::max(fault, SafetyStage::Refused);
    }
    if (state.faded == 1) fault = std::max(fault, SafetyStage::Stale);
    if (state.cool_down_share == 1) fault = std::max(fault, SafetyStage::CoolDown);
    if (ending_share == 0) fault = std::max(fault, SafetyStage::Ending);
    if (state.not_finite) fault = SafetyStage::NotFinite;

    // off, waiting, rising, on
    if (state.engagement == Engagement::Fresh) {
        state.engagement = settings.starts_engaged ? Engagement::On : Engagement::Waiting;
        state.risen = settings.starts_engaged ? 1 : 0;
    }
    if (fault != SafetyStage::None) {
        stop(state, fault);
        const bool is_sudden = fault > SafetyStage::CoolDown;
        const Vec3 from = is_sudden ? Vec3(Vec3::Zero()) : state.sent_newton;
        state.sent_newton = slewed(settings, from, Vec3::Zero(), elapsed.s, fault);
        return {state.sent_newton, fault, state.reason, 0};
    }
    SafetyResult result;
    result.stage = update_engagement(settings, state, input.wanted_newton, elapsed.s);
    if (state.faded > 0) result.stage = std::max(result.stage, SafetyStage::Stale);
    if (state.cool_down_share > 0) result.stage = std::max(result.stage, SafetyStage::CoolDown);
    if (ending_share < 1) result.stage = std::max(result.stage, SafetyStage::Ending);

    // fades, clamp, slew
    result.share = state.risen * (1 - state.faded) * (1 - state.cool_down_share) * ending_share;
    const double before = result.share;
    const Vec3 force = clamped(input.wanted_newton * result.share, clamp_newton, result.share);
    if (result.share < before) {
        const SafetyStage clamp =
            state.glided > 0 ? SafetyStage::ThermalLimit : SafetyStage::Clamped;
        result.stage = std::max(result.stage, clamp);
        // Cold motors would have been clamped too, and that has given no energy.
        const double cold_newton =
            std::min(input.wanted_newton.norm() * before, settings.clamp_newton);
        if (state.glided > 0) result.heat_share = std::min(1.0, force.norm() / cold_newton);
    }
    result.newton = slewed(settings, state.sent_newton, force, elapsed.s, result.stage);
    result.reason = state.reason;
    state.sent_newton = result.newton;
    return result;
}

void disengage(SafetyState& state) noexcept {
    state.engagement = Engagement::Off;
    state.quiet_cycles = 0;
    state.risen = 0;
}

void engage(SafetyState& state) noexcept {
    if (state.engagement != Engagement::Off) return;
    state.engagement = Engagement::Waiting;
    forget(state);
}

bool is_latched(const SafetyState& state) noexcept { return state.not_finite; }

void release(SafetyState& state) noexcept { state.not_finite = false; }

}  // namespace palpa
