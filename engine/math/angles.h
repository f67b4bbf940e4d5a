// Angles are in radians, but where people read them.
#pragma once
#include <numbers>

namespace palpa {

inline constexpr double degrees_per_radian = 180 / std::numbers::pi;

}  // namespace palpa
