// Superposes two sets of points by a rigid motion.
#pragma once
#include "math/rigid_motion.h"

#include <span>

namespace palpa {

// Of all rotations and translations the one with the least sum of squared distances between
// motion * from[i] and to[i]: W. Kabsch, Acta Cryst. A32, 922 (1976). As many points here as there;
// without three that are on no line one of several that are as good. Identity without points.
RigidMotion superpose(std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace palpa
