// Spatial vectors: motion and force of a rigid body in one, six numbers about one point, angular
// part first. (R. Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 2)
#pragma once
#include "math/vec.h"

namespace palpa {

// (angular acceleration, acceleration of the point) or (torque about the point, force).
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// cross_matrix(a) * b = a x b
inline Mat3 cross_matrix(const Vec3& a) noexcept {
    Mat3 result;
    result << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return result;
}

}  // namespace palpa
