// The vector, matrix and quaternion types of the physics, in double; pictures use their own in
// float.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace palpa {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

// The same direction, but no longer than that; of what is not finite nothing is promised.
inline Vec3 shortened(const Vec3& way, double longest) noexcept {
    const double length = way.stableNorm();
    return length > longest ? Vec3(way * (longest / length)) : way;
}

// The rotation of a rotation vector: about its direction by its length (rad).
inline Quat turn_of(const Vec3& rotation_vector) noexcept {
    const double angle = rotation_vector.norm();
    if (angle == 0) return Quat::Identity();
    return Quat(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

// The rotation vector of a rotation; its length is at most pi.
inline Vec3 rotation_vector_of(const Quat& turn) noexcept {
    const Eigen::AngleAxisd around(turn);
    return around.angle() * around.axis();
}

}  // namespace palpa
