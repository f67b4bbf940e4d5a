#include "devices/rate_handle.h"

#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

// The vector, no longer than that; nothing where it is no number.
Vec3 limited(const Vec3& vector, double longest) noexcept {
    return std::isfinite(vector.stableNorm()) ? shortened(vector, longest) : Vec3(Vec3::Zero());
}

}  // namespace

double beyond_dead_zone(double deflection, double dead_zone) noexcept {
    const double size = std::abs(deflection);
    if (!(size > dead_zone)) return 0;
    return std::copysign(std::min((size - dead_zone) / (1 - dead_zone), 1.0), deflection);
}

void RateHandle::move(const HandRate& rate, double dt_s) noexcept {
    position_m_ += dt_s * limited(rate.m_per_s, fastest_m_per_s);
    position_m_ = position_m_.cwiseMax(-half_box_m).cwiseMin(half_box_m);
    const Vec3 turn = dt_s * limited(rate.rad_per_s, fastest_rad_per_s);
    orientation_ = (turn_of(turn) * orientation_).normalized();
}

void RateHandle::return_to_middle(double dt_s) noexcept {
    position_m_ -= limited(position_m_, return_m_per_s * dt_s);
}

}  // namespace palpa
