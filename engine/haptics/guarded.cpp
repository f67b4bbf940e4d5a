#include "haptics/guarded.h"

#include "core/repeatable.h"
#include "core/units.h"
#include "haptics/device.h"
#include "math/eigenvectors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace palpa {
namespace {

// Velocity is the difference between two readings through a low-pass of first order.
constexpr double velocity_filter_s = 0.002;

// Over this time it is averaged how much of the handle's travel the limits let pass.
constexpr double share_filter_s = 0.01;

// Laws that are exchanged while they are felt glide in this time.
constexpr double law_glide_s = 0.1;

// Where everything follows the hand, a new model's force is blended in over this time at least, and
// no tick changes the force at the handle by more than this because of it.
constexpr double relaxed_blend_s = 0.03, most_blended_newton = 0.03;

// The surroundings of the molecule: the newest contact model, and where other hands have theirs.
// Where everything follows, atoms that follow a fast hand linearly can come on each other, so no
// more counts than the force at which a molecule stops.
struct Surroundings {
    const LocalContactModel& contact;
    LiveMolecules live;
    double stop_newton;

    LocalForce at(const MoleculePose& pose) const noexcept {
        LocalForce there = evaluate_local(contact.model, contact.field, pose, live);
        if (contact.model.relaxed) there.force_newton = shortened(there.force_newton, stop_newton);
        return there;
    }
};

// What the molecule may go in this tick, Å: a part of the clearance, and on average, where the
// field is one of the last step only, no more than until the next model comes. What it did not need
// is saved up to the former: at long periods the average is less than an encoder step.
double update_allowance(const LocalContactModel& contact, GuardedState& state) noexcept {
    constexpr double in_contact = 0.02, in_contact_per_model = 0.2;  // Å
    // A tangent knows no wall.
    const double trusted = contact.field.has_atoms ? 1 : 0.15;
    const double clearance = state.at_place.clearance_angstrom;
    const double period =
        std::max({contact.model.period_s, state.interval_s, state.since_arrival_s});
    double refill = (in_contact_per_model + trusted * clearance) * servo_tick_s / period;
    if (contact.field.has_atoms && !contact.model.is_compliant)
        refill = std::numeric_limits<double>::infinity();
    state.allowance_angstrom =
        std::min(in_contact + 0.1 * clearance, state.allowance_angstrom + refill);
    return state.allowance_angstrom;
}

// How far the molecule may go along a way (Å) before it leaves the region in which the contact
// model holds; the clearance comes on top.
double find_reach(const LocalContactModel& contact, const Vec3& way,
                  const GuardedState& state) noexcept {
    const ContactModel& model = contact.model;
    const double length = way.norm();
    if (!model.relaxed || length == 0) return std::numeric_limits<double>::infinity();
    const double clearance = contact.field.has_atoms ? state.at_place.clearance_angstrom : 0;
    const double reach = model.relaxed->reach_angstrom + clearance;
    const Vec3 gone = state.molecule.place_angstrom - model.molecule.place_angstrom +
                      model.relaxed->gone_angstrom;
    // Where the way leaves the sphere; from outside of it, its nearest point at least.
    const double back = -gone.dot(way) / length;
    const double square = back * back + reach * reach - gone.squaredNorm();
    return std::max(0.0, back + std::sqrt(std::max(0.0, square)));
}

// The stiffness by which a step of the molecule changes the force: the relaxed one within the
// region in which the contact model holds, beyond it the frozen one.
const Mat3& find_felt_stiffness(const ContactModel& model, const GuardedState& state) noexcept {
    constexpr double rounding = 1e-6;  // Å: a molecule that waits stands at the edge
    if (!model.relaxed) return state.at_place.stiffness_N_per_m;
    const Vec3 gone = state.molecule.place_angstrom - model.molecule.place_angstrom +
                      model.relaxed->gone_angstrom;
    const bool is_within = gone.norm() <= model.relaxed->reach_angstrom + rounding;
    return is_within ? state.at_place.slope_N_per_m : state.at_place.stiffness_N_per_m;
}

// Where limits cut off travel the force still acts on the handle, and what it does there comes from
// nothing; the servo's own damping takes some of it again, and of that no more than this is saved.
constexpr double most_saved_J = 3e-3;

void update_energy_balance(const GuardedSettings& settings, double work_from_nothing_J,
                           GuardedState& state) noexcept {
    const double damped =
        settings.damping_N_s_per_m * state.handle_m_per_s.squaredNorm() * servo_tick_s;
    state.energy_balance_J =
        std::max(-most_saved_J, state.energy_balance_J + work_from_nothing_J - damped);
}

// Of the law's force: where it has done too much of that, it drives the handle by the share that
// the molecule follows.
double passivity_scaling(const GuardedState& state) noexcept {
    constexpr double allowed_J = 0.1e-3, too_much_J = 0.2e-3;
    const bool drives = state.law_newton.dot(state.handle_m_per_s) > 0;
    if (!drives || !(state.wanted_m > 0) || state.energy_balance_J < allowed_J) return 1;
    const double grip =
        std::min(1.0, (state.energy_balance_J - allowed_J) / (too_much_J - allowed_J));
    return 1 - grip * (1 - state.allowed_m / state.wanted_m);
}

// Travel beyond the handle's own carries a molecule through free space. Where a force is felt it
// fades: nobody would have done the work.
Vec3 find_extra_travel(const GuardedSettings& settings, const Vec3& handle_m, const Vec3& moved_m,
                       const GuardedState& state) noexcept {
    constexpr double felt_newton = 0.1, allowed_gain_J = 0.1e-3;
    const Vec3 force = state.at_place.force_newton + state.blend_residual_newton;
    const double free = 1 - hand_force(settings.force_law, force).norm() / felt_newton;
    if (!(free > 0) || state.energy_balance_J > allowed_gain_J) return Vec3::Zero();
    return free * extra_travel(settings.workspace, handle_m, moved_m, settings.half_workspace_m,
                               servo_tick_s);
}

// Goes by so much (Å) and turns if no atom is pushed too hard there, or less than before.
bool try_move(const GuardedSettings& settings, const Surroundings& around, const Vec3& by,
              const Quat& turn, GuardedState& state) noexcept {
    const MoleculePose pose{state.molecule.place_angstrom + by,
                            (turn * state.molecule.orientation).normalized()};
    const LocalForce there = around.at(pose);
    const bool is_allowed = there.largest_newton <= settings.stop_newton ||
                            there.largest_newton < state.at_place.largest_newton;
    if (!is_allowed) return false;
    state.molecule = pose;
    state.at_place = there;
    return true;
}

// What of a way (Å) and a turn the molecule follows, as the stop allows; returns that way. Where it
// may not go on, it may slide: across the force. Where it may not turn, it goes without.
Vec3 follow(const GuardedSettings& settings, const Surroundings& around, const Vec3& way,
            const Quat& turn, GuardedState& state) noexcept {
    const Quat none = Quat::Identity();
    const bool turns = turn.vec() != Vec3::Zero();
    if (way.isZero() && !turns) return way;
    if (try_move(settings, around, way, turn, state) || way.isZero()) return way;
    if (turns && try_move(settings, around, way, none, state)) return way;
    const Vec3 force = state.at_place.force_newton;
    const double along = way.dot(force), norm2 = force.squaredNorm();
    if (along >= 0 || norm2 == 0) return Vec3::Zero();
    const Vec3 across = way - along / norm2 * force;
    if (across.squaredNorm() < 1e-6 * way.squaredNorm()) return Vec3::Zero();
    return try_move(settings, around, across, none, state) ? across : Vec3(Vec3::Zero());
}

// `felt`: Jacobian times stiffness, N/m times A_d.
GuardedGain tensor_gain(double law, const Mat3& felt, double cap_N_per_m) noexcept {
    const auto [values, axes] = find_eigenvectors(Mat3(0.5 * (felt + felt.transpose())));
    Vec3 A_d = (values / cap_N_per_m).cwiseMax(law);
    const Mat3 inverse = axes * A_d.cwiseInverse().asDiagonal() * axes.transpose();
    // What is not symmetric of it adds to the stiffness once the axes differ.
    const double cap_ratio = std::max(1.0, largest_felt(felt * inverse) / cap_N_per_m);
    A_d *= cap_ratio;
    return {A_d.maxCoeff(),
            largest_felt(felt * inverse) / cap_ratio,
            axes * A_d.asDiagonal() * axes.transpose(),
            inverse / cap_ratio,
            felt * inverse / cap_ratio,
            A_d.maxCoeff() / law};
}

// What the molecule did of what the handle asked.
struct Followed {
    double share = 1;             // that the limits of a step left of it
    Vec3 moved_m = Vec3::Zero();  // handle travel of which it went the way
};

// With one gain, no atom further than `most` (Å), and what it owes (Å) besides. Takes what it goes
// from the allowance.
Followed follow_handle(const GuardedSettings& settings, const Surroundings& around,
                       const GuardedGain& gain, const HandleStep& asked, const Vec3& remainder,
                       double most, GuardedState& state) noexcept {
    const Vec3 way = units::angstrom_per_metre * (gain.inverse * asked.moved_m) + remainder;
    const Vec3 turn = rotation_vector_of(asked.turned);
    const double radius = around.contact.field.radius;
    const double length = way.norm() + turn.norm() * radius;
    const double reach = std::min(most, find_reach(around.contact, way, state));
    Followed done;
    if (length > reach) done.share = reach / length;
    const Quat before = state.molecule.orientation;
    const Vec3 tried = done.share * way;
    const Vec3 gone = follow(settings, around, tried, turn_of(done.share * turn), state);
    done.moved_m = gone == tried ? Vec3(done.share * asked.moved_m)
                                 : Vec3(units::metre_per_angstrom * (gain.tensor * gone));
    const double turned =
        rotation_vector_of(state.molecule.orientation * before.conjugate()).norm();
    state.allowance_angstrom = std::max(0.0, most - gone.norm() - turned * radius);
    return done;
}

// What the last step went too far or not far enough (Å), now that it is known what held at its end:
// a way is the mean of both ends', or it would drift.
Vec3 find_remainder(const GuardedGain& gain, const GuardedState& state) noexcept {
    if (state.stepped_m.isZero()) return Vec3::Zero();
    const Mat3 mean = 0.5 * (state.began_with + gain.inverse);
    return units::angstrom_per_metre * ((mean - state.went_with) * state.stepped_m);
}

// How the old model's force goes over into the new one's. Where everything follows, `most_blended`
// limits what the handle feels of that in a tick.
void update_blend(const GuardedSettings& settings, bool is_relaxed, GuardedState& state) noexcept {
    const Vec3 before = state.blend_residual_newton;
    double left = repeatable::exp(-4 * servo_tick_s / std::max(state.blend_s, servo_tick_s));
    state.blend_residual_newton *= left;
    if (!is_relaxed) return;
    const auto felt_with = [&](const Vec3& residual) {
        return hand_force(settings.force_law, state.at_place.force_newton + residual);
    };
    const Vec3 felt = felt_with(before);
    constexpr int tries = 8;  // the law may bend on the way
    for (int i = 0; i < tries; ++i) {
        const double change = (felt_with(state.blend_residual_newton) - felt).norm();
        if (!(change > most_blended_newton)) return;
        left = 1 - 0.9 * (1 - left) * most_blended_newton / change;
        state.blend_residual_newton = left * before;
    }
}

// What the rest of an old model's force does to the handle comes from nothing.
double find_blend_work(const GuardedSettings& settings, const Vec3& moved_m,
                       const GuardedState& state) noexcept {
    const auto felt_with = [&](const Vec3& residual) {
        return hand_force(settings.force_law, state.at_place.force_newton + residual);
    };
    return (felt_with(state.blend_residual_newton) - felt_with(Vec3::Zero())).dot(moved_m);
}

// The gain of a step that has led to where another one holds: of where it is stiffer that of there,
// since no more than the cap may be felt; else of halfway.
std::optional<GuardedGain> find_better_gain(const GuardedSettings& settings,
                                            const ContactModel& model, const GuardedGain& gain,
                                            const GuardedState& state) noexcept {
    constexpr double much = 1.05;
    GuardedGain there =
        guarded_gain(settings, state.at_place.force_newton + state.blend_residual_newton,
                     state.at_place.stiffness_N_per_m, find_felt_stiffness(model, state));
    if (there.A_d > much * gain.A_d) return there;
    if (there.A_d * much > gain.A_d || !there.tensor.allFinite()) return std::nullopt;
    const double least = gain.felt_N_per_m / (most_of_cap * settings.cap_N_per_m);
    const double share = std::max(least, 2 * there.A_d / (there.A_d + gain.A_d));
    GuardedGain halfway = gain;
    halfway.A_d *= share;
    halfway.cap_ratio *= share;
    halfway.felt_N_per_m /= share;
    halfway.tensor *= share;
    halfway.inverse /= share;
    halfway.felt /= share;
    return halfway;
}

// Keeps the travel that the molecule did not follow, where everything follows the hand: up to the
// travel that presses that way against the stop as overtravel, the rest as waiting travel. Returns
// what is clipped.
Vec3 keep_travel(const Vec3& held, const Vec3& cut, const Vec3& pressing,
                 GuardedState& state) noexcept {
    const double length = held.norm();
    const double pressed = length > 0 ? std::max(0.0, pressing.dot(held) / length) : 0;
    state.overtravel_m = shortened(held, pressed);
    const Vec3 waiting = held + cut - state.overtravel_m;
    state.waiting_m = shortened(waiting, most_waiting_m);
    return waiting - state.waiting_m;
}

// Clutched, a hand has no hold of the molecule and feels none: what pulled at the handle while it
// is carried back would be work that nobody did. Forces go and come quickly enough not to be
// missed, and what the stop has kept is gone with them.
void update_hold(bool is_clutched, GuardedState& state) noexcept {
    constexpr double lets_go_s = 0.08, takes_hold_s = 0.2;
    const double change = servo_tick_s / (is_clutched ? -lets_go_s : takes_hold_s);
    state.clutch_blend = std::clamp(state.clutch_blend + change, 0.0, 1.0);
    if (state.clutch_blend == 0) state.overtravel_m.setZero();
}

// A third of what shakes a handle by itself.
double most_damping(double inertia_kg, int delay_ticks) noexcept {
    constexpr double third_of_critical = std::numbers::pi / 6;
    const double horizon_s = velocity_filter_s + (1.5 + delay_ticks) * servo_tick_s;
    return third_of_critical * inertia_kg / horizon_s;
}

}  // namespace

double guarded_cap(double viscosity_N_s_per_m, double damping_N_s_per_m, int delay_ticks) noexcept {
    const double stable = 0.5 * (viscosity_N_s_per_m + damping_N_s_per_m) /
                          ((0.5 + std::max(1, delay_ticks)) * servo_tick_s);
    const double lossless =
        damping_N_s_per_m > 0 ? damping_N_s_per_m / ((1.5 + delay_ticks) * servo_tick_s) : stable;
    return std::max(1.0, std::min(stable, lossless));
}

double guarded_cap(const DeviceSpec& device, double damping_N_s_per_m, int delay_ticks) noexcept {
    return device.cap_N_per_m > 0
               ? device.cap_N_per_m
               : guarded_cap(device.viscosity_N_s_per_m, damping_N_s_per_m, delay_ticks);
}

double guarded_damping(double damping_N_s_per_m, double inertia_kg, int delay_ticks) noexcept {
    return std::min(damping_N_s_per_m, most_damping(inertia_kg, delay_ticks));
}

double guarded_horizon(double cap_N_per_m, double damping_N_s_per_m, double inertia_kg,
                       int delay_ticks) noexcept {
    const double room = std::max(0.0, most_damping(inertia_kg, delay_ticks) - damping_N_s_per_m);
    return std::min((0.5 + delay_ticks) * servo_tick_s, room / cap_N_per_m);
}

GuardedGain guarded_gain(const GuardedSettings& settings, const Vec3& force_newton,
                         const Mat3& stiffness, const Mat3& felt_stiffness) noexcept {
    double law = displacement_gain(settings.displacement_law, force_newton.norm(),
                                   std::abs(extreme_stiffness(stiffness)));
    if (settings.least_A_d_per_newton > 0) {
        const double felt_newton = hand_force(settings.force_law, force_newton).norm();
        law = std::max(law, settings.least_A_d_per_newton * felt_newton);
    }
    const Mat3 felt = force_jacobian(settings.force_law, force_newton) * felt_stiffness;
    if (settings.gain_shape == GainShape::Tensor && felt.allFinite())
        return tensor_gain(law, felt, settings.cap_N_per_m);
    const double largest = largest_felt(felt);
    const double A_d = capped_gain(law, largest, settings.cap_N_per_m);
    return {A_d,        largest / A_d, A_d * Mat3::Identity(), 1 / A_d * Mat3::Identity(),
            felt / A_d, A_d / law};
}

GuardedGain guarded_gain(const GuardedSettings& settings, const Vec3& force_newton,
                         const Mat3& stiffness) noexcept {
    return guarded_gain(settings, force_newton, stiffness, stiffness);
}

Vec3 filtered_velocity(const Vec3& before_m_per_s, const Vec3& moved_m) noexcept {
    const double keep = velocity_filter_s / (velocity_filter_s + servo_tick_s);
    constexpr double most_m = 1;
    const double norm = moved_m.stableNorm();
    Vec3 counted = moved_m;
    if (!std::isfinite(norm)) counted = Vec3(most_m, 0, 0);  // no direction is left of it
    if (norm > most_m && std::isfinite(norm)) counted *= most_m / norm;
    return keep * before_m_per_s + (1 - keep) / servo_tick_s * counted;
}

void take_local_contact(const GuardedSettings& settings, const LocalContactModel& contact,
                        GuardedState& state, LiveMolecules live) noexcept {
    const ContactModel& model = contact.model;
    const Vec3 felt = state.at_place.force_newton + state.blend_residual_newton;
    const bool goes_on =
        state.is_placed && state.grip_number == model.grip_number && !model.is_still;
    if (!goes_on) {
        state.molecule = model.molecule;
        state.overtravel_m.setZero();
        state.waiting_m.setZero();
        state.stepped_m.setZero();
        state.holds_another =
            state.is_placed && state.grip_number != model.grip_number && !model.is_still;
        if (!state.holds_another) state.felt_newton.setZero();
        state.law_newton = state.felt_newton;
        state.law_blend_residual_newton.setZero();
        state.wanted_m = state.allowed_m = state.energy_balance_J = 0;
    }
    state.at_place = Surroundings{contact, live, settings.stop_newton}.at(state.molecule);
    state.blend_residual_newton.setZero();
    if (goes_on) state.blend_residual_newton = felt - state.at_place.force_newton;
    state.interval_s = goes_on ? state.since_arrival_s : model.period_s;
    state.blend_s = model.relaxed ? std::max(state.interval_s, relaxed_blend_s) : state.interval_s;
    state.since_arrival_s = 0;
    state.grip_number = model.grip_number;
    state.is_placed = true;
}

GuardedTick step_guarded(const GuardedSettings& settings, const LocalContactModel& contact,
                         const Vec3& handle_m, const HandleStep& handle, bool is_clutched,
                         GuardedState& state, LiveMolecules live) noexcept {
    const Vec3& moved_m = handle.moved_m;
    GuardedTick tick;
    const ContactModel& model = contact.model;
    state.handle_m_per_s = filtered_velocity(state.handle_m_per_s, moved_m);
    if (!state.is_placed || model.is_still) return tick;

    const Surroundings around{contact, live, settings.stop_newton};
    // Other hands have moved since.
    if (!contact.field.held.empty()) state.at_place = around.at(state.molecule);
    const Vec3 before = state.at_place.force_newton + state.blend_residual_newton;
    GuardedGain gain = guarded_gain(settings, before, state.at_place.stiffness_N_per_m,
                                    find_felt_stiffness(model, state));
    Vec3 own = Vec3::Zero(), extra = Vec3::Zero();
    if (!is_clutched) {
        extra = model.projector * find_extra_travel(settings, handle_m, moved_m, state);
        own = model.projector * (handle.followed * moved_m) + extra;
    }
    const Vec3 pressing = own + state.overtravel_m, waiting = state.waiting_m;
    const Vec3 wanted = pressing + waiting;
    const bool turns = model.turns_with_handle && !is_clutched;
    const HandleStep asked{wanted, turns ? handle.turned : Quat::Identity()};
    const double most = update_allowance(contact, state);
    const Vec3 remainder = find_remainder(gain, state);
    const Mat3 began_with = gain.inverse;
    const MoleculePose from = state.molecule;
    const LocalForce at_from = state.at_place;
    Followed done = follow_handle(settings, around, gain, asked, remainder, most, state);
    if (const std::optional<GuardedGain> better = find_better_gain(settings, model, gain, state)) {
        state.molecule = from;
        state.at_place = at_from;
        gain = *better;
        done = follow_handle(settings, around, gain, asked, remainder, most, state);
    }
    const auto& [share, followed] = done;
    tick.displacement_gain = gain.A_d;
    tick.cap_ratio = gain.cap_ratio;
    tick.felt_N_per_m = gain.felt_N_per_m;
    tick.molecule_per_handle = gain.inverse;
    // Keep the travel that the stop held back as overtravel. Clip the travel that the limits cut
    // off, except for earlier overtravel; in flexible scenes keep that too, until the model is
    // there.
    const Vec3 cut = (1 - share) * wanted;
    const Vec3 kept_cut = shortened(cut, state.overtravel_m.norm());
    const Vec3 held = share * wanted - followed + kept_cut;
    tick.clipped_m = cut - kept_cut;
    if (model.relaxed) {
        tick.clipped_m = keep_travel(held, tick.clipped_m, pressing, state);
    } else {
        state.overtravel_m = held;
        state.waiting_m.setZero();
    }
    const bool is_whole = followed == wanted;
    state.stepped_m = is_whole ? wanted : Vec3(Vec3::Zero());
    state.began_with = began_with;
    state.went_with = gain.inverse;

    update_blend(settings, model.relaxed.has_value(), state);
    tick.force_newton = state.at_place.force_newton + state.blend_residual_newton;
    // Foretold for where the handle is when it acts; else what is late by t gives K t v² to a hand.
    Vec3 law = hand_force(settings.force_law, tick.force_newton);
    const Mat3 felt = model.relaxed ? Mat3(force_jacobian(settings.force_law, tick.force_newton) *
                                           state.at_place.slope_N_per_m * gain.inverse)
                                    : gain.felt;
    if (felt.allFinite()) law -= settings.horizon_s * (felt * state.handle_m_per_s);
    if (settings.revision != state.revision || state.holds_another) {
        const Vec3 jump = state.law_newton - law;
        if (jump.allFinite()) state.law_blend_residual_newton = jump;
        state.revision = settings.revision;
        state.holds_another = false;
    }
    state.law_blend_residual_newton *= repeatable::exp(-servo_tick_s / law_glide_s);
    state.law_newton = law + state.law_blend_residual_newton;
    const double remember = share_filter_s / (share_filter_s + servo_tick_s);
    state.wanted_m = remember * state.wanted_m + wanted.norm();
    state.allowed_m = remember * state.allowed_m + share * wanted.norm();
    tick.damping_newton = -settings.damping_N_s_per_m * state.handle_m_per_s;
    update_hold(is_clutched, state);
    state.felt_newton = passivity_scaling(state) * state.law_newton -
                        settings.cap_N_per_m * state.overtravel_m -
                        waiting_N_per_m * state.waiting_m;
    tick.hand_newton = state.clutch_blend * state.felt_newton + tick.damping_newton;
    double from_nothing_J =
        state.law_newton.dot(tick.clipped_m + state.waiting_m - waiting - extra);
    if (model.relaxed)
        from_nothing_J += state.clutch_blend * find_blend_work(settings, moved_m, state);
    update_energy_balance(settings, from_nothing_J, state);
    state.since_arrival_s += servo_tick_s;
    return tick;
}

}  // namespace palpa
