// The one place where servo and simulation meet: two mailboxes, the hand's pose inward and the
// touch model outward. Here the loop from hand to molecule to hand is closed.
#pragma once
#include "core/mailbox.h"
#include "math/vec.h"

namespace palpa {

// What the servo tells the simulation, every tick.
struct HandPose {
    double time_s = 0;
    Vec3 travel_m = Vec3::Zero();  // handle travel so far, but for what was travelled clutched
};

// What the simulation tells the servo, every step, of the molecule in the hand. One simulation
// step old when it is felt: the paper's z^-1.
struct TouchModel {
    double time_s = 0;                        // of the hand pose that it answers
    Vec3 molecule_angstrom = Vec3::Zero();    // reference atom, from its counterpart
    Vec3 force_newton = Vec3::Zero();         // on the molecule, along what it may do
    Vec3 torque_newton_metre = Vec3::Zero();  // about its centre of mass; felt by no device so far
    double stiffness_N_per_m = 0;       // -dF/dx where it is largest of what the molecule may do
    double displacement_gain = 0;       // A_d of the step that led here
    double potential_kcal_per_mol = 0;  // of the molecule and its environment
    int active_freedom = 0;             // degrees of freedom that the step could move
    double period_s = 0;                // of the simulation
};

struct Exchange {
    Mailbox<HandPose> hand;
    Mailbox<TouchModel> touch;
};

}  // namespace palpa
