#include "haptics/guarded.h"

#include "core/units.h"
#include "haptics/device.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpa {
namespace {

// Velocity is the difference between two readings through a low-pass of first order.
constexpr double velocity_filter_s = 0.002;

// Over this time it is averaged how much of the handle's travel the limits let pass.
constexpr double share_filter_s = 0.01;

// Laws that are exchanged while they are felt glide in this time.
constexpr double law_glide_s = 0.1;

// What the molecule may go in this tick, Å: a part of the clearance, and on average, where the
// field is one of the last step only, no more than until the next model comes. What it did not need
// is saved up to the former: at long periods the average is less than an encoder step.
double update_allowance(const Touch& touch, GuardedState& state) noexcept {
    constexpr double in_contact = 0.02, in_contact_per_model = 0.2;  // Å
    // A tangent knows no wall.
    const double trusted = touch.field.has_atoms ? 1 : 0.15;
    const double clearance = state.at_place.clearance_angstrom;
    const double period = std::max({touch.model.period_s, state.interval_s, state.since_arrival_s});
    double refill = (in_contact_per_model + trusted * clearance) * servo_tick_s / period;
    if (touch.field.has_atoms && !touch.model.gives_way)
        refill = std::numeric_limits<double>::infinity();
    state.allowance_angstrom =
        std::min(in_contact + 0.1 * clearance, state.allowance_angstrom + refill);
    return state.allowance_angstrom;
}

// Where limits cut off travel the force still acts on the handle, and what it does there comes from
// nothing; the servo's own damping takes some of it again, and of that no more than this is saved.
constexpr double most_saved_J = 3e-3;

void update_debt(const GuardedSettings& settings, const Vec3& dropped_m,
                 GuardedState& state) noexcept {
    const double damped =
        settings.damping_N_s_per_m * state.handle_m_per_s.squaredNorm() * servo_tick_s;
    state.debt_J = std::max(-most_saved_J, state.debt_J + state.law_newton.dot(dropped_m) - damped);
}

// Of the law's force: where it has done too much of that, it drives the handle by the share that
// the molecule follows.
double driven_share(const GuardedState& state) noexcept {
    constexpr double allowed_J = 0.1e-3, too_much_J = 0.2e-3;
    const bool drives = state.law_newton.dot(state.handle_m_per_s) > 0;
    if (!drives || !(state.wanted_m > 0) || state.debt_J < allowed_J) return 1;
    const double grip = std::min(1.0, (state.debt_J - allowed_J) / (too_much_J - allowed_J));
    return 1 - grip * (1 - state.allowed_m / state.wanted_m);
}

// Travel beyond the handle's own carries a molecule through free space. Where a force is felt it
// fades: nobody would have done the work.
Vec3 find_extra_travel(const GuardedSettings& settings, const Vec3& handle_m, const Vec3& moved_m,
                       const GuardedState& state) noexcept {
    constexpr double felt_newton = 0.1, owed_J = 0.1e-3;
    const Vec3 force = state.at_place.force_newton + state.jump_newton;
    const double free = 1 - hand_force(settings.force_law, force).norm() / felt_newton;
    if (!(free > 0) || state.debt_J > owed_J) return Vec3::Zero();
    return free * extra_travel(settings.workspace, handle_m, moved_m, settings.half_workspace_m,
                               servo_tick_s);
}

// Goes to a place if no atom is pushed too hard there, or less than before.
bool try_place(const GuardedSettings& settings, const Touch& touch, const Vec3& place,
               GuardedState& state) noexcept {
    const LocalForce there = evaluate_local(touch.model, touch.field, place);
    const bool is_allowed = there.largest_newton <= settings.stop_newton ||
                            there.largest_newton < state.at_place.largest_newton;
    if (!is_allowed) return false;
    state.place_angstrom = place;
    state.at_place = there;
    return true;
}

// Handle travel of which the molecule follows what the stop allows; returns that. Where it may not
// go on, it may slide: across the force.
Vec3 follow(const GuardedSettings& settings, const Touch& touch, const Vec3& travel_m,
            double angstrom_per_m, GuardedState& state) noexcept {
    const Vec3 from = state.place_angstrom;
    if (travel_m.isZero()) return travel_m;
    if (try_place(settings, touch, from + travel_m * angstrom_per_m, state)) return travel_m;
    const Vec3 force = state.at_place.force_newton;
    const double along = travel_m.dot(force), norm2 = force.squaredNorm();
    if (along >= 0 || norm2 == 0) return Vec3::Zero();
    const Vec3 across = travel_m - along / norm2 * force;
    if (across.squaredNorm() < 1e-6 * travel_m.squaredNorm()) return Vec3::Zero();
    return try_place(settings, touch, from + across * angstrom_per_m, state) ? across
                                                                             : Vec3(Vec3::Zero());
}

}  // namespace

double guarded_cap(double viscosity_N_s_per_m, double damping_N_s_per_m, int delay_ticks) noexcept {
    const double stable = 0.5 * (viscosity_N_s_per_m + damping_N_s_per_m) /
                          ((0.5 + std::max(1, delay_ticks)) * servo_tick_s);
    const double lossless =
        damping_N_s_per_m > 0 ? damping_N_s_per_m / ((1.5 + delay_ticks) * servo_tick_s) : stable;
    return std::max(1.0, std::min(stable, lossless));
}

double guarded_damping(double damping_N_s_per_m, double inertia_kg, int delay_ticks) noexcept {
    constexpr double third_of_critical = std::numbers::pi / 6;
    const double late_s = velocity_filter_s + (1.5 + delay_ticks) * servo_tick_s;
    return std::min(damping_N_s_per_m, third_of_critical * inertia_kg / late_s);
}

GuardedGain guarded_gain(const GuardedSettings& settings, const Vec3& force_newton,
                         const Mat3& stiffness) noexcept {
    const double law = displacement_gain(settings.displacement_law, force_newton.norm(),
                                         std::abs(extreme_stiffness(stiffness)));
    const double felt = largest_felt(settings.force_law, force_newton, stiffness);
    const double A_d = capped_gain(law, felt, settings.cap_N_per_m);
    return {A_d, felt / A_d};
}

void take_touch(const Touch& touch, GuardedState& state) noexcept {
    const TouchModel& model = touch.model;
    const Vec3 felt = state.at_place.force_newton + state.jump_newton;
    const bool goes_on = state.is_placed && state.start == model.start && !model.is_still;
    if (!goes_on) {
        state.place_angstrom = model.molecule_angstrom;
        state.kept_m.setZero();
        state.law_newton.setZero();
        state.law_jump_newton.setZero();
        state.wanted_m = state.allowed_m = state.debt_J = 0;
    }
    state.at_place = evaluate_local(model, touch.field, state.place_angstrom);
    state.jump_newton.setZero();
    if (goes_on) state.jump_newton = felt - state.at_place.force_newton;
    state.interval_s = goes_on ? state.since_arrival_s : model.period_s;
    state.since_arrival_s = 0;
    state.start = model.start;
    state.is_placed = true;
}

GuardedTick step_guarded(const GuardedSettings& settings, const Touch& touch, const Vec3& handle_m,
                         const Vec3& moved_m, bool is_clutched, GuardedState& state) noexcept {
    GuardedTick tick;
    const TouchModel& model = touch.model;
    const double keep = velocity_filter_s / (velocity_filter_s + servo_tick_s);
    state.handle_m_per_s = keep * state.handle_m_per_s + (1 - keep) / servo_tick_s * moved_m;
    if (!state.is_placed || model.is_still) return tick;

    const Vec3 before = state.at_place.force_newton + state.jump_newton;
    const Mat3& stiffness = state.at_place.stiffness_N_per_m;
    const auto [A_d, felt] = guarded_gain(settings, before, stiffness);
    tick.displacement_gain = A_d;
    tick.felt_N_per_m = felt;

    const double angstrom_per_m = units::angstrom_per_metre / A_d;
    Vec3 own = Vec3::Zero(), extra = Vec3::Zero();
    if (!is_clutched) {
        extra = model.projector * find_extra_travel(settings, handle_m, moved_m, state);
        own = model.projector * moved_m + extra;
    }
    const Vec3 wanted = own + state.kept_m;
    const double length = wanted.norm() * angstrom_per_m, most = update_allowance(touch, state);
    const double share = length > most ? most / length : 1;
    const Vec3 followed = follow(settings, touch, share * wanted, angstrom_per_m, state);
    state.allowance_angstrom =
        std::max(0.0, state.allowance_angstrom - followed.norm() * angstrom_per_m);
    // What the stop held back is kept; what the limits cut off is not, but for what was kept.
    const Vec3 cut = (1 - share) * wanted;
    const double kept_norm = state.kept_m.norm(), cut_norm = cut.norm();
    const Vec3 kept_cut = cut_norm > kept_norm ? Vec3(cut * (kept_norm / cut_norm)) : cut;
    tick.dropped_m = cut - kept_cut;
    state.kept_m = share * wanted - followed + kept_cut;

    state.jump_newton *= std::exp(-4 * servo_tick_s / std::max(state.interval_s, servo_tick_s));
    tick.force_newton = state.at_place.force_newton + state.jump_newton;
    const Vec3 law = hand_force(settings.force_law, tick.force_newton);
    if (settings.revision != state.revision) {
        const Vec3 jump = state.law_newton - law;
        if (jump.allFinite()) state.law_jump_newton += jump;
        state.revision = settings.revision;
    }
    state.law_jump_newton *= std::exp(-servo_tick_s / law_glide_s);
    state.law_newton = law + state.law_jump_newton;
    const double remember = share_filter_s / (share_filter_s + servo_tick_s);
    state.wanted_m = remember * state.wanted_m + wanted.norm();
    state.allowed_m = remember * state.allowed_m + share * wanted.norm();
    tick.hand_newton = driven_share(state) * state.law_newton -
                       settings.cap_N_per_m * state.kept_m -
                       settings.damping_N_s_per_m * state.handle_m_per_s;
    update_debt(settings, tick.dropped_m - extra, state);
    state.since_arrival_s += servo_tick_s;
    return tick;
}

}  // namespace palpa
