// The vector, matrix and quaternion types of the physics, in double; pictures use their own in
// float.
#pragma once
#include "core/repeatable.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace palpa {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

// The same direction, but no longer than that; of what is not finite nothing is promised.
inline Vec3 shortened(const Vec3& way, double longest) noexcept {
    const double length = way.stableNorm();
    return length > longest ? Vec3(way * (longest / length)) : way;
}

// The rotation by an angle (rad) about a unit axis. Eigen's AngleAxis and slerp() use the standard
// library's functions, which are not repeatable.
inline Quat turn_by(double angle, const Vec3& axis) noexcept {
    Quat turn(repeatable::cos(angle / 2), 0, 0, 0);
    turn.vec() = repeatable::sin(angle / 2) * axis;
    return turn;
}

// The rotation of a rotation vector: about its direction by its length (rad).
inline Quat turn_of(const Vec3& rotation_vector) noexcept {
    const double angle = rotation_vector.norm();
    if (angle == 0) return Quat::Identity();
    return turn_by(angle, rotation_vector / angle);
}

// The rotation vector of a rotation; its length is at most pi.
inline Vec3 rotation_vector_of(const Quat& turn) noexcept {
    const double sine = turn.vec().norm();
    if (sine == 0) return Vec3::Zero();
    const double angle = 2 * repeatable::atan2(sine, std::abs(turn.w()));
    return turn.vec() * ((turn.w() < 0 ? -angle : angle) / sine);
}

// The rotation after a `share` of the shortest way from one rotation to another.
inline Quat turn_between(const Quat& from, const Quat& to, double share) noexcept {
    return turn_of(share * rotation_vector_of(to * from.conjugate())) * from;
}

}  // namespace palpa
