// A handle that is not there, for devices that have no position of their own: what a hand does to
// a cap, a stick or a key is a rate, and this is where it leads. SI; axes: x right, y up, z towards
// the user. Pure: no threads, no clock.
#pragma once
#include "haptics/device.h"
#include "math/vec.h"

namespace palpa {

// Of a deflection that is 1 where cap or stick end: nothing up to `dead_zone`, then evenly up to 1,
// on both sides; never beyond. What is no number is 0.
double beyond_dead_zone(double deflection, double dead_zone) noexcept;

class RateHandle {
public:
    // Half of its box, between the long and the short sides of the Omni's; chosen, not measured.
    static constexpr double half_box_m = 0.060;
    // No faster than this, whatever the rate: a quarter of what the safety chain takes for a
    // handle that was torn away.
    static constexpr double fastest_m_per_s = 0.35, fastest_rad_per_s = 6;
    // With which it comes back to the middle.
    static constexpr double return_m_per_s = 0.30;

    // Goes on at a rate for a time; at a side of its box it slides along it. A rate that is no
    // number is none.
    void move(const HandRate& rate, double dt_s) noexcept;

    // Goes back to the middle, and keeps its turn: for as long as the clutch lets go of the
    // molecule, which then has the whole box before it again.
    void return_to_middle(double dt_s) noexcept;

    const Vec3& position_m() const noexcept { return position_m_; }
    const Quat& orientation() const noexcept { return orientation_; }

private:
    Vec3 position_m_ = Vec3::Zero();
    Quat orientation_ = Quat::Identity();
};

}  // namespace palpa
