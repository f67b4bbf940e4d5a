// Guarded coupling: the servo itself moves the molecule in the field of the last simulation step,
// so that force and stiffness are up to date at every tick, whatever the period of the simulation.
#pragma once
#include "core/choices.h"
#include "haptics/device.h"
#include "haptics/exchange.h"
#include "haptics/gains.h"
#include "haptics/workspace.h"
#include "math/vec.h"

#include <cstdint>

namespace palpa {

struct GuardedSettings {
    ForceLaw force_law = PrintedForceLaw({});
    DisplacementLaw displacement_law = RepairedDisplacementLaw({});
    GainShape gain_shape = GainShape::Scalar;
    WorkspaceMap workspace = {};
    // The stiffness cap, N/m: A_d is raised until the stiffness felt is below it. Default: half of
    // the stability limit of a device with this damping, 0.5 (B_h + B)/(1.5 T).
    double cap_N_per_m = 200;
    double device_cap_N_per_m = 200;  // the device's own, of which `cap_N_per_m` is a part
    // A_d is no less than this much for each newton that is felt: where the law is steep, a
    // molecule that is far from any wall would else go further in a tick than the limits of a step
    // let it.
    double least_A_d_per_newton = 0;
    double damping_N_s_per_m = 0.5;         // B
    double horizon_s = 1.5 * servo_tick_s;  // prediction horizon of the force
    double stop_newton = 10e-9;  // contact force on the molecule or one atom at which it stops
    Vec3 half_workspace_m = Vec3::Constant(0.1);  // half workspace of the device
    std::uint32_t revision = 0;  // a new number means new laws; the force is blended to them
};

// The stiffness (N/m) that a hand may feel: half of what a device of this viscosity, with this
// damping added, keeps stable at the servo's own period, 0.5 (B_h + B)/(1.5 T), T longer by each
// tick of delay beyond the first; and no more than so that the damping takes what a force that is
// half a tick, one of holding and the delay late gives, B/((1.5 + delay) T). At least 1.
double guarded_cap(double viscosity_N_s_per_m, double damping_N_s_per_m, int delay_ticks) noexcept;
// The same for a device: what it states, or from its viscosity.
double guarded_cap(const DeviceSpec& device, double damping_N_s_per_m, int delay_ticks) noexcept;

// What of a damping (N s/m) is played: late by its filter and the servo's delay it shakes a light
// handle by itself from pi/2 m/delay on, and a third of that is the most.
double guarded_damping(double damping_N_s_per_m, double inertia_kg, int delay_ticks) noexcept;

// How far ahead (s) the force is predicted: from a reading to the middle of the tick in which its
// force acts, half a tick and the delay. That damps as well, by up to the cap times this, and no
// more than `guarded_damping` has room for.
double guarded_horizon(double cap_N_per_m, double damping_N_s_per_m, double inertia_kg,
                       int delay_ticks) noexcept;

// What a tick may feel of the cap: out of a stiff place the gain is the mean of what holds at both
// ends, or the molecule would drift, and where the tick begins more is felt than the cap.
inline constexpr double most_of_cap = 1.1;

// While the molecule waits for its contact model, the handle's travel is kept and pulls back as a
// spring of this stiffness, weak enough that the force of the molecule is still told from it.
// Travel beyond its largest force is clipped.
inline constexpr double waiting_N_per_m = 15, most_waiting_newton = 0.3;
inline constexpr double most_waiting_m = most_waiting_newton / waiting_N_per_m;

struct GuardedGain {
    double A_d = 0;           // handle metres per molecule metre, where it is largest
    double felt_N_per_m = 0;  // of the stiffness, where it is largest
    // A_d as a tensor, and its inverse, molecule metres per handle metre: dr = inverse dx.
    Mat3 tensor = Mat3::Zero(), inverse = Mat3::Zero();
    Mat3 felt = Mat3::Zero();  // stiffness felt at the handle as a tensor, N/m
    double cap_ratio = 1;      // largest A_d divided by that of the law (cap ratio)
};

// Returns the law's A_d at this force (N), raised until the stiffness felt is below the cap. A
// tensor gain is raised along each eigenvector of sym(J K) on its own; J is the Jacobian of the
// force law, K the stiffness that is felt (N/m). `stiffness`: of the frozen surroundings, for the
// law's term.
GuardedGain guarded_gain(const GuardedSettings& settings, const Vec3& force_newton,
                         const Mat3& stiffness, const Mat3& felt_stiffness) noexcept;
// The same where the frozen stiffness is felt.
GuardedGain guarded_gain(const GuardedSettings& settings, const Vec3& force_newton,
                         const Mat3& stiffness) noexcept;

// The state between two ticks.
struct GuardedState {
    bool is_placed = false;
    std::uint32_t grip_number = 0;  // grip number of the contact model
    MoleculePose molecule;
    Vec3 overtravel_m =
        Vec3::Zero();  // handle travel that the stop did not let the molecule follow
    // Handle travel that the molecule will follow once its contact model is there, at most
    // `most_waiting_m`; only where everything follows the hand.
    Vec3 waiting_m = Vec3::Zero();
    LocalForce at_place;
    double allowance_angstrom = 0;  // distance that it may move at once
    // The last step, if it was followed whole: handle travel, and molecule per handle travel as it
    // was where it began, and as was taken.
    Vec3 stepped_m = Vec3::Zero();
    Mat3 began_with = Mat3::Zero(), went_with = Mat3::Zero();
    Vec3 blend_residual_newton = Vec3::Zero();  // the old model's force less the new one's, fading
    double since_arrival_s = 0,
           interval_s = 0;               // of contact models: the last, between the last two
    double blend_s = 0;                  // time constant in which this residual fades
    Vec3 handle_m_per_s = Vec3::Zero();  // low-pass filtered velocity
    // Recent sums, m: handle travel that the molecule should follow, and the part that the limits
    // allowed.
    double wanted_m = 0, allowed_m = 0;
    double energy_balance_J =
        0;  // work on the hand where the molecule did not follow, less what was damped
    double clutch_blend = 1;          // clutch blend, 0 to 1, of the force on the hand
    Vec3 law_newton = Vec3::Zero();   // output of the force law
    Vec3 felt_newton = Vec3::Zero();  // the same with the overtravel force, as felt
    Vec3 law_blend_residual_newton =
        Vec3::Zero();  // the old law's force less the new one's, fading
    std::uint32_t revision = 0;
    bool holds_another =
        false;  // the hand holds something else since the last tick: the force is blended to it
};

// The result of a tick.
struct GuardedTick {
    Vec3 hand_newton = Vec3::Zero();     // force on the hand
    Vec3 damping_newton = Vec3::Zero();  // its damping part
    Vec3 force_newton = Vec3::Zero();    // force on the molecule
    double displacement_gain = 0;        // largest A_d
    double cap_ratio = 1;                // cap ratio
    double felt_N_per_m = 0;             // largest stiffness felt
    Mat3 molecule_per_handle =
        Mat3::Zero();               // molecule travel per handle travel: inverse of A_d as a tensor
    Vec3 clipped_m = Vec3::Zero();  // clipped travel of the handle at the limits of a step
};

// The motion of the handle in a tick.
struct HandleStep {
    Vec3 moved_m = Vec3::Zero();
    Quat turned = Quat::Identity();
    double followed = 1;  // share of the travel that the molecule follows
};

// The handle's velocity after a tick in which it moved by that much, through a low-pass. What no
// handle does, more than a metre in a tick, counts as a metre, and is soon forgotten.
Vec3 filtered_velocity(const Vec3& before_m_per_s, const Vec3& moved_m) noexcept;

// A contact model has come, in place of `before`'s. To be called in the tick in which it is first
// seen, before step_guarded. `live`: what other hands hold, as far as their servos have got.
void take_local_contact(const GuardedSettings& settings, const LocalContactModel& contact,
                        GuardedState& state, LiveMolecules live = {}) noexcept;

// Moves the molecule with the handle, and turns it if that is what the handle does to it, as far
// as limits let it. In one tick of 1 ms the handle went by `handle` to `handle_m`; clutched, that
// is none of the molecule's. `contact` is the one taken last.
GuardedTick step_guarded(const GuardedSettings& settings, const LocalContactModel& contact,
                         const Vec3& handle_m, const HandleStep& handle, bool is_clutched,
                         GuardedState& state, LiveMolecules live = {}) noexcept;

}  // namespace palpa
