#include "math/rigid_motion.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace palpa;

TEST_CASE("a quarter turn is right-handed about its axis, wherever that is", "[math]") {
    const RigidMotion turn = turn_about({1, 2, 3}, Vec3::UnitZ(), std::numbers::pi / 2);

    // One beside the axis along x goes along y.
    CHECK((turn * Vec3(2, 2, 5) - Vec3(1, 3, 5)).norm() < 1e-15);
    CHECK((turn * Vec3(1, 2, -7) - Vec3(1, 2, -7)).norm() < 1e-15);
}

TEST_CASE("a turn keeps distances and leaves its axis", "[math]") {
    const Vec3 point(1, -2, 0.5), axis = Vec3(2, 1, -1).normalized(), a(3, 1, 4), b(-1, 5, 9);
    const RigidMotion turn = turn_about(point, axis, 0.7);

    CHECK((turn * Vec3(point + 3 * axis) - (point + 3 * axis)).norm() < 1e-14);
    CHECK((turn * a - turn * b).norm() == Approx((a - b).norm()).epsilon(1e-14));
    // O. Rodrigues' formula.
    const Vec3 arm = a - point;
    const Vec3 expected = point + std::cos(0.7) * arm + std::sin(0.7) * axis.cross(arm) +
                          (1 - std::cos(0.7)) * axis.dot(arm) * axis;
    CHECK((turn * a - expected).norm() < 1e-14);
}

TEST_CASE("of two motions the inner one goes first", "[math]") {
    const RigidMotion outer = turn_about({1, 0, 0}, Vec3::UnitX(), 1.1);
    const RigidMotion inner = turn_about({0, 2, 1}, Vec3::UnitY(), -0.4);
    const Vec3 x(1, 2, 3);

    CHECK((outer * inner * x - outer * (inner * x)).norm() < 1e-14);
    CHECK(((outer * inner) * x - (inner * outer) * x).norm() > 0.1);
    CHECK((RigidMotion{} * x - x).norm() == 0);
}

TEST_CASE("a motion and its inverse bring every point back", "[math]") {
    const RigidMotion motion = turn_about({1, -4, 2}, Vec3(1, 2, -2) / 3, 2.1);
    const Vec3 x(1, 2, 3);

    CHECK((motion.inverse() * (motion * x) - x).norm() < 1e-14);
    CHECK((motion * (motion.inverse() * x) - x).norm() < 1e-14);
}
