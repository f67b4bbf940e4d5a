// Where a rigid body has gone: x' = rotation x + translation.
#pragma once
#include "math/vec.h"

namespace palpa {

struct RigidMotion {
    Mat3 rotation = Mat3::Identity();
    Vec3 translation = Vec3::Zero();

    Vec3 operator*(const Vec3& point) const noexcept { return rotation * point + translation; }

    // First `inner`, then this.
    RigidMotion operator*(const RigidMotion& inner) const noexcept {
        return {rotation * inner.rotation, rotation * inner.translation + translation};
    }

    // The way back.
    RigidMotion inverse() const noexcept {
        return {rotation.transpose(), -(rotation.transpose() * translation)};
    }
};

// By `angle` (rad) about an axis of length 1 through a point, right-handed.
inline RigidMotion turn_about(const Vec3& point, const Vec3& axis, double angle) noexcept {
    RigidMotion motion;
    motion.rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    motion.translation = point - motion.rotation * point;
    return motion;
}

}  // namespace palpa
