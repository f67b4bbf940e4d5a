// The field on the molecule in the hand between two steps of the simulation.
#pragma once
#include "field/frozen_field.h"
#include "math/spatial.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// Where the molecule in the hand is.
struct MoleculePose {
    Vec3 place_angstrom = Vec3::Zero();   // its reference atom, from its counterpart
    Quat orientation = Quat::Identity();  // about that atom, from how it was loaded
};

// How what is held pulls if everything around it, and its own joints, follow the hand at once.
struct RelaxedStiffness {
    // -d(torque about the reference atom, force)/d(turn, place): N m, N and N/m, of what the
    // molecule may do; symmetric. Zero for turns where the handle turns nothing.
    Mat6 matrix = Mat6::Zero();
    // How far it may go, Å, from the contact model's place less `gone_angstrom`, before this holds
    // no more.
    double reach_angstrom = 0;
    Vec3 gone_angstrom = Vec3::Zero();
};

// What the simulation sends to the servo, every step, of the molecule in the hand. SI but for
// places.
struct ContactModel {
    double time_s = 0;  // of the hand pose that it answers
    MoleculePose molecule;
    Vec3 force_newton = Vec3::Zero();         // on the molecule, along what it may do
    Vec3 torque_newton_metre = Vec3::Zero();  // about its centre of mass; felt by no device so far
    double stiffness_N_per_m = 0;       // -dF/dx where it is largest of what the molecule may do
    double displacement_gain = 0;       // A_d of the step that led here
    double potential_kcal_per_mol = 0;  // of the molecule and its environment
    int active_freedom = 0;             // degrees of freedom that the step could move
    double period_s = 0;                // of the simulation
    // Of the force, against complete relaxation of everything mobile, and Å that the hand has gone
    // from where the model of it was linearised. Not a number where that is not known.
    double error_estimate_newton = std::numeric_limits<double>::quiet_NaN();
    double model_age_angstrom = std::numeric_limits<double>::quiet_NaN();

    // What follows is for guarded coupling alone.
    Mat3 projector = Mat3::Identity();  // onto what the molecule may do
    bool turns_with_handle = false;
    Mat3 stiffness_matrix_N_per_m = Mat3::Zero();                         // of that
    double clearance_angstrom = std::numeric_limits<double>::infinity();  // as in LocalForce
    // The change of force and torque in the compliant environment, as a share of the change in a
    // frozen one, 0 to 1.
    double prediction_gain = 1, torque_prediction_gain = 1;
    // Whether what is around the molecule moves from step to step. Where it does not, the field is
    // as good far from the contact model's place as there.
    bool is_compliant = true;
    // By which the force is predicted between steps, where the step answers by second order. What
    // keeps the loop stable and the molecule out of walls takes the frozen stiffness all the same.
    std::optional<RelaxedStiffness> relaxed = {};
    std::uint32_t start = 0;   // another number: the molecule was put there, not by the hand
    bool is_still = false;     // nothing moves: the hand has no hold
    std::uint64_t number = 0;  // of those that a live session has posted to this hand's servo
};

// What a hand holds, where the servo has put it by now.
struct LiveMolecule {
    MoleculePose pose;
    std::uint32_t start = 0;  // of the hand's contact model
};

// By hand slot; nothing for a hand whose molecule the servo does not move.
using LiveMolecules = std::span<const std::optional<LiveMolecule>>;

// The molecule that another hand holds, as it stood at the step. The servo moves it with that hand.
struct HeldField {
    std::size_t hand = 0;       // slot of that hand
    LiveMolecule then;          // its place then, measured from what does not move
    Vec3 pivot = Vec3::Zero();  // Å, its reference atom then, about which it turns
    FrozenField frozen;         // of its atoms; may be empty where the local field has no atoms
    FrozenSum there;            // of that on the group, both as they stood
    // -d(force on the group)/d(place of this molecule) where everything follows, N/m.
    Mat3 relaxed_N_per_m = Mat3::Zero();
};

// How atoms follow the hand's way, and what the field says of that where they stood.
struct FollowingAtoms {
    FollowingPoints points;  // of the group, and of the field's environment
    FollowingSum there;
    // Å of the hand's way, beyond which the farthest of them has left the region where all this
    // holds: what they add then stays as it is.
    double reach_angstrom = 0;
    mutable FollowingMemory memory;  // that evaluations write to: one thread at a time
};

// Of one step; either the atoms, where they stood, or nothing, and then the stiffness of the
// contact model is all that is known. Atoms that other hands hold are in `held`, not in `frozen`.
struct LocalField {
    FrozenField frozen;
    std::vector<Vec3> group;     // Å, of the molecule in the hand
    Vec3 centre = Vec3::Zero();  // Å, of its mass
    Vec3 pivot = Vec3::Zero();   // Å, its reference atom, about which it turns
    double radius = 0;           // Å, of the atom that is furthest from there
    FrozenSum there;             // of the field on the group where it is
    bool has_atoms = false;
    std::vector<HeldField> held;  // one for each other hand whose molecule is near
    // Where everything follows, and the handle turns nothing.
    std::optional<FollowingAtoms> following = {};
};

// All of a local field on the group where it was.
FrozenSum sum_there(const LocalField& field) noexcept;

// The same on a group elsewhere, moved by `motion` besides, with what other hands hold where `live`
// has it.
FrozenSum evaluate_field(const LocalField& field, std::span<const Vec3> group,
                         const RigidMotion& motion, LiveMolecules live) noexcept;

// What the molecule feels at a place.
struct LocalForce {
    Vec3 force_newton = Vec3::Zero();
    Vec3 torque_newton_metre = Vec3::Zero();  // about the centre of mass
    Mat3 stiffness_N_per_m = Mat3::Zero();    // -d(force)/d(place), of what it may do
    // The same as the force is predicted: another one where everything follows.
    Mat3 slope_N_per_m = Mat3::Zero();
    // To the nearest place where a pair repels, Å, 0 or more.
    double clearance_angstrom = std::numeric_limits<double>::infinity();
    // On it as a whole, or a bound of that on any atom of it, whichever is more: the sum of what
    // the environment and each held molecule do to the atom that they push hardest.
    double largest_newton = 0;
};

// At a pose near the contact model's: its force and what the field says of the way from there, the
// confirmed share of it,
//     F(r) = F_L + rho (F_frozen(r) - F_frozen(r_L)),
// so that a field of some atoms, or in single precision, never makes it jump. Without atoms
// F_L - K (r - r_L), whatever the turn. Without allocation or lock.
//
// F_frozen includes the molecules of other hands, as rigid bodies that went from r_L to where
// `live` has them; one that is not there, or that was taken up anew since, is where it stood.
// Without atoms each adds K_held (s - s_L), s its place.
//
// With a relaxed stiffness instead F_L - K_relaxed (r - r_L), and the torque likewise. Atoms that
// follow add what is beyond first order, and walls are where they have gone to by then:
//     F(r) = F_L - K_relaxed d + P(d) - P(0) + P'(0) d, d = r - r_L,
// P minus the slope of the field's energy along d with all atoms moved by X d. All else is as in
// the frozen field, unscaled. `field` may be evaluated by one thread at a time.
LocalForce evaluate_local(const ContactModel& model, const LocalField& field,
                          const MoleculePose& pose, LiveMolecules live = {}) noexcept;

// The eigenvalue of largest magnitude.
double extreme_stiffness(const Mat3& stiffness) noexcept;

}  // namespace palpa
