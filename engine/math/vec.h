// The vector and matrix types of the physics, in double; pictures use their own in float.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace palpa {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

}  // namespace palpa
