// What the coupling would be without period, delay, limits, friction and damping: the yardstick of
// a run in space, where even that does work on a closed path.
#pragma once
#include "ecs/world.h"
#include "haptics/guarded.h"

namespace palpa {

// A rigid molecule goes by dx/A_d, and turns as the handle does; the hand feels the force law of
// the force that is on it there, in double and of all pairs. Owns its world.
class ContinuousLaw {
public:
    // Begins where the simulation stands. Only for guarded coupling.
    ContinuousLaw(GuardedSettings settings, World world);

    // The handle has gone on by so much: by the midpoint rule, in steps of 0.01 Å at most.
    void follow(const HandleStep& handle);

    MoleculePose pose() const noexcept;
    double work_joule() const noexcept { return work_J_; }           // done on the hand so far
    double farthest_angstrom() const noexcept { return farthest_; }  // of the reference atoms

    // The largest stiffness (N/m) that a hand feels of a molecule elsewhere that goes by
    // `molecule_per_handle` of what the handle does.
    double felt_stiffness(const MoleculePose& place, const Mat3& molecule_per_handle);

private:
    struct Here {
        Vec3 hand_newton = Vec3::Zero();
        Mat3 metre_per_metre = Mat3::Zero();  // molecule travel of handle travel
    };
    Here find_here() const;

    GuardedSettings settings_;
    World world_;
    double work_J_ = 0, farthest_ = 0;
};

}  // namespace palpa
