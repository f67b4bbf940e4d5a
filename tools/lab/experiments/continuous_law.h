// The ideal coupling without period, delay, limits, friction and damping. It is the reference for
// runs in space, where even the ideal law does work on a closed path.
#pragma once
#include "ecs/world.h"
#include "haptics/guarded.h"

namespace palpa {

// A rigid molecule moves by dx/A_d and turns as the handle does; the hand feels the force law of
// the molecular force at that place, computed in double from all pairs. Owns its world.
class ContinuousLaw {
public:
    // Starts from the state of the simulation. For guarded coupling only.
    ContinuousLaw(GuardedSettings settings, World world);

    // Follows a step of the handle by the midpoint rule, in steps of at most 0.01 Å.
    void follow(const HandleStep& handle);

    MoleculePose pose() const noexcept;
    double work_joule() const noexcept { return work_J_; }  // work on the hand so far
    // Largest distance of the reference atoms.
    double farthest_angstrom() const noexcept { return farthest_; }

    // The largest stiffness (N/m) that a hand feels of a molecule elsewhere that goes by
    // `molecule_per_handle` of what the handle does.
    double felt_stiffness(const MoleculePose& place, const Mat3& molecule_per_handle);

private:
    struct Here {
        Vec3 hand_newton = Vec3::Zero();
        Mat3 metre_per_metre = Mat3::Zero();  // molecule travel per handle travel
    };
    Here find_here() const;

    GuardedSettings settings_;
    World world_;
    double work_J_ = 0, farthest_ = 0;
};

}  // namespace palpa
