// A virtual handle for devices without a position of their own: the deflection of a cap, stick or
// key is a velocity, which is integrated here. SI units; axes: x right, y up, z towards the user.
// Pure: no threads, no clock.
#pragma once
#include "haptics/device.h"
#include "math/vec.h"

namespace palpa {

// Applies a dead zone to a deflection (-1 to 1 at the ends): 0 up to `dead_zone`, then linear up to
// 1, on both sides. NaN gives 0.
double beyond_dead_zone(double deflection, double dead_zone) noexcept;

class RateHandle {
public:
    // Half edge of the box of the handle, m, between the long and the short sides of the Omni's
    // workspace; chosen, not measured.
    static constexpr double half_box_m = 0.060;
    // Speed limits, a quarter of the speed that the safety chain treats as a torn-away handle.
    static constexpr double fastest_m_per_s = 0.35, fastest_rad_per_s = 6;
    // Speed of the return to the middle.
    static constexpr double return_m_per_s = 0.30;

    // Moves at a rate for the time `dt_s`; at a side of the box the handle slides along it. A rate
    // that is NaN counts as 0.
    void move(const HandRate& rate, double dt_s) noexcept;

    // Moves back to the middle and keeps the orientation. Call it while the clutch releases the
    // molecule, so that the whole box is available again.
    void return_to_middle(double dt_s) noexcept;

    const Vec3& position_m() const noexcept { return position_m_; }
    const Quat& orientation() const noexcept { return orientation_; }

private:
    Vec3 position_m_ = Vec3::Zero();
    Quat orientation_ = Quat::Identity();
};

}  // namespace palpa
