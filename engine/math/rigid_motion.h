// Rigid motion: x' = rotation x + translation.
#pragma once
#include "math/vec.h"

namespace palpa {

struct RigidMotion {
    Mat3 rotation = Mat3::Identity();
    Vec3 translation = Vec3::Zero();

    Vec3 operator*(const Vec3& point) const noexcept { return rotation * point + translation; }

    // The motion `inner` followed by this one.
    RigidMotion operator*(const RigidMotion& inner) const noexcept {
        return {rotation * inner.rotation, rotation * inner.translation + translation};
    }

    // The inverse motion.
    RigidMotion inverse() const noexcept {
        return {rotation.transpose(), -(rotation.transpose() * translation)};
    }
};

// Rotation by `angle` (rad), right-handed, about a unit axis through a point.
inline RigidMotion turn_about(const Vec3& point, const Vec3& axis, double angle) noexcept {
    RigidMotion motion;
    motion.rotation = turn_by(angle, axis).toRotationMatrix();
    motion.translation = point - motion.rotation * point;
    return motion;
}

}  // namespace palpa
