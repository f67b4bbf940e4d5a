// The field on the molecule in the hand between two steps of the simulation.
#pragma once
#include "field/frozen_field.h"
#include "math/vec.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace palpa {

// Where the molecule in the hand is.
struct MoleculePose {
    Vec3 place_angstrom = Vec3::Zero();   // its reference atom, from its counterpart
    Quat orientation = Quat::Identity();  // about that atom, from how it was loaded
};

// What the simulation tells the servo, every step, of the molecule in the hand. SI but for places.
struct TouchModel {
    double time_s = 0;  // of the hand pose that it answers
    MoleculePose molecule;
    Vec3 force_newton = Vec3::Zero();         // on the molecule, along what it may do
    Vec3 torque_newton_metre = Vec3::Zero();  // about its centre of mass; felt by no device so far
    double stiffness_N_per_m = 0;       // -dF/dx where it is largest of what the molecule may do
    double displacement_gain = 0;       // A_d of the step that led here
    double potential_kcal_per_mol = 0;  // of the molecule and its environment
    int active_freedom = 0;             // degrees of freedom that the step could move
    double period_s = 0;                // of the simulation

    // What follows is for guarded coupling alone.
    Mat3 projector = Mat3::Identity();  // onto what the molecule may do
    bool turns_with_handle = false;
    Mat3 stiffness_matrix_N_per_m = Mat3::Zero();                         // of that
    double clearance_angstrom = std::numeric_limits<double>::infinity();  // as in LocalForce
    // The share of what a frozen environment would change in force and torque that the one that
    // gives way did change, 0 to 1.
    double confirmed = 1, confirmed_torque = 1;
    // Whether what is around the molecule moves from step to step. Where it does not, the field is
    // as good far from the touch model's place as there.
    bool gives_way = true;
    std::uint32_t start = 0;  // another number: the molecule was put there, not by the hand
    bool is_still = false;    // nothing moves: the hand has no hold
};

// Of one step; either the atoms, where they stood, or nothing, and then the stiffness of the touch
// model is all that is known.
struct LocalField {
    FrozenField frozen;
    std::vector<Vec3> group;     // Å, of the molecule in the hand
    Vec3 centre = Vec3::Zero();  // Å, of its mass
    Vec3 pivot = Vec3::Zero();   // Å, its reference atom, about which it turns
    double radius = 0;           // Å, of the atom that is furthest from there
    FrozenSum there;             // of the field on the group where it is
    bool has_atoms = false;
};

// What the molecule feels at a place.
struct LocalForce {
    Vec3 force_newton = Vec3::Zero();
    Vec3 torque_newton_metre = Vec3::Zero();  // about the centre of mass
    Mat3 stiffness_N_per_m = Mat3::Zero();    // -d(force)/d(place), of what it may do
    // To the nearest place where a pair repels, Å, 0 or more.
    double clearance_angstrom = std::numeric_limits<double>::infinity();
    double largest_newton = 0;  // on any atom of it, or on it as a whole, whichever is more
};

// At a pose near the touch model's: its force and what the field says of the way from there, the
// confirmed share of it,
//     F(r) = F_L + rho (F_frozen(r) - F_frozen(r_L)),
// so that a field of some atoms, or in single precision, never makes it jump. Without atoms
// F_L - K (r - r_L), whatever the turn. Without allocation or lock.
LocalForce evaluate_local(const TouchModel& model, const LocalField& field,
                          const MoleculePose& pose) noexcept;

// The eigenvalue of largest magnitude.
double extreme_stiffness(const Mat3& stiffness) noexcept;

}  // namespace palpa
