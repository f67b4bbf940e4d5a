// The force field on the molecule in the hand between two simulation steps (local contact model).
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

// Pose of the molecule in the hand.
struct MoleculePose {
    Vec3 place_angstrom =
        Vec3::Zero();  // position of its reference atom, relative to its counterpart
    Quat orientation = Quat::Identity();  // rotation about that atom since loading
};

// The stiffness of the held molecule if everything around it and its own joints relax at once.
struct RelaxedStiffness {
    // -d(torque about the reference atom, force)/d(turn, place): N m, N and N/m, of what the
    // molecule may do; symmetric. Zero for turns where the handle turns nothing.
    Mat6 matrix = Mat6::Zero();
    // Distance from the contact model's place, minus `gone_angstrom`, up to which this is valid, Å.
    double reach_angstrom = 0;
    Vec3 gone_angstrom = Vec3::Zero();
};

// The contact model: sent by the simulation to the servo in every step, for the molecule in the
// hand. SI units except positions.
struct ContactModel {
    double time_s = 0;  // time of the hand pose to which it belongs
    MoleculePose molecule;
    Vec3 force_newton = Vec3::Zero();  // force on the molecule in its allowed directions
    Vec3 torque_newton_metre =
        Vec3::Zero();                   // about its centre of mass; no present device renders it
    double stiffness_N_per_m = 0;       // largest -dF/dx in the allowed directions
    double displacement_gain = 0;       // A_d of the step
    double potential_kcal_per_mol = 0;  // interaction energy of the molecule with its environment
    int active_freedom = 0;             // active degrees of freedom of the step
    double period_s = 0;                // period of the simulation
    // Of the force, against complete relaxation of everything mobile, and Å that the hand has gone
    // from where the model of it was linearised. Not a number where that is not known.
    double error_estimate_newton = std::numeric_limits<double>::quiet_NaN();
    double model_age_angstrom = std::numeric_limits<double>::quiet_NaN();

    // The following fields are for guarded coupling only.
    Mat3 projector = Mat3::Identity();  // projector onto the allowed directions of the molecule
    bool turns_with_handle = false;
    Mat3 stiffness_matrix_N_per_m = Mat3::Zero();                         // stiffness matrix
    double clearance_angstrom = std::numeric_limits<double>::infinity();  // see LocalForce
    // Prediction gains: the change of force and torque in the compliant environment as a share of
    // the change in a frozen one, 0 to 1.
    double prediction_gain = 1, torque_prediction_gain = 1;
    // Whether what is around the molecule moves from step to step. Where it does not, the field is
    // as good far from the contact model's place as there.
    bool is_compliant = true;
    // By which the force is predicted between steps, where the step answers by second order. What
    // keeps the loop stable and the molecule out of walls takes the frozen stiffness all the same.
    std::optional<RelaxedStiffness> relaxed = {};
    std::uint32_t grip_number = 0;  // a new number: the molecule was placed, not moved by the hand
    bool is_still = false;          // paused: the hand has no force
    std::uint64_t number = 0;       // number of the model in a live session
};

// The molecule of a hand at the position where the servo has moved it.
struct LiveMolecule {
    MoleculePose pose;
    std::uint32_t grip_number = 0;  // grip number of the hand's contact model
};

// By hand slot; unset for a hand whose molecule the servo does not move.
using LiveMolecules = std::span<const std::optional<LiveMolecule>>;

// The molecule that another hand holds, as it stood at the step. The servo moves it with that hand.
struct HeldField {
    std::size_t hand = 0;       // slot of the other hand
    LiveMolecule then;          // its pose at the step, relative to something fixed
    Vec3 pivot = Vec3::Zero();  // Å, its reference atom at the step, about which it turns
    FrozenField frozen;         // field of its atoms; may be empty if the local field has no atoms
    FrozenSum at_step;          // force of that field on the group at the step
    // -d(force on the group)/d(place of this molecule) where everything follows, N/m.
    Mat3 relaxed_N_per_m = Mat3::Zero();
};

// How atoms follow the motion of the hand, and the field at their positions of the step.
struct FollowingAtoms {
    FollowingPoints points;  // motion of the group's and the environment's atoms
    FollowingSum at_step;
    // Å of the hand's way, beyond which the farthest of them has left the region where all this
    // holds: what they add then stays as it is.
    double reach_angstrom = 0;
    mutable FollowingMemory memory;  // memory for evaluations: one thread at a time
};

// Of one step; either the atoms, where they stood, or nothing, and then the stiffness of the
// contact model is all that is known. Atoms that other hands hold are in `held`, not in `frozen`.
struct LocalField {
    FrozenField frozen;
    std::vector<Vec3> group;     // atoms of the molecule in the hand, Å
    Vec3 centre = Vec3::Zero();  // its centre of mass, Å
    Vec3 pivot = Vec3::Zero();   // its reference atom, about which it turns, Å
    double radius = 0;           // distance of its farthest atom from there, Å
    FrozenSum at_step;           // force of the field on the group at the step
    bool has_atoms = false;
    std::vector<HeldField> held;  // one for each other hand with a molecule nearby
    // Where everything follows, and the handle turns nothing.
    std::optional<FollowingAtoms> following = {};
};

// The total force of a local field on the group at the step.
FrozenSum sum_at_step(const LocalField& field) noexcept;

// The same on a group elsewhere, moved by `motion` besides, with what other hands hold where `live`
// has it.
FrozenSum evaluate_field(const LocalField& field, std::span<const Vec3> group,
                         const RigidMotion& motion, LiveMolecules live) noexcept;

// The force on the molecule at a pose.
struct LocalForce {
    Vec3 force_newton = Vec3::Zero();
    Vec3 torque_newton_metre = Vec3::Zero();  // about the centre of mass
    Mat3 stiffness_N_per_m = Mat3::Zero();    // -d(force)/d(place) in the allowed directions
    // The stiffness used for the prediction; different if the environment relaxes.
    Mat3 slope_N_per_m = Mat3::Zero();
    // Distance to the nearest repulsion of a pair, Å, 0 or more.
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

// The eigenvalue with the largest magnitude, N/m.
double extreme_stiffness(const Mat3& stiffness) noexcept;

}  // namespace palpa
