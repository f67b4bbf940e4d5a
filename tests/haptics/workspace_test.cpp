#include "haptics/workspace.h"

#include "haptics/device.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace palpa;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const Vec3 half{0.080, 0.060, 0.035};

// Random places out to 1.5 times the workspace.
Vec3 random_place(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1.5, 1.5);
    return half.cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random)));
}

Vec3 bubble_velocity(const Vec3& handle) {
    return extra_travel(BubbleMap{}, handle, Vec3::Zero(), half, servo_tick_s) / servo_tick_s;
}

}  // namespace

TEST_CASE("with the clutch alone the handle's travel is all", "[haptics][workspace]") {
    CHECK(extra_travel(ClutchMap{}, half, 0.1 * half, half, servo_tick_s) == Vec3::Zero());
}

TEST_CASE("a loop inside the bubble leaves the molecule where it was", "[haptics][workspace]") {
    Vec3 sum = Vec3::Zero(), before = half.cwiseProduct(Vec3(0.59, 0, 0.3));
    for (int i = 1; i <= 500; ++i) {
        const double angle = 2 * std::numbers::pi * i / 500;
        const Vec3 handle =
            half.cwiseProduct(Vec3(0.59 * std::cos(angle), 0.59 * std::sin(angle), 0.3));
        sum += extra_travel(BubbleMap{}, handle, handle - before, half, servo_tick_s);
        before = handle;
    }

    CHECK(sum == Vec3::Zero());
}

TEST_CASE("outside the bubble the molecule goes on with the square of the excess",
          "[haptics][workspace]") {
    // Between 0.6 and 1 of the half workspace: half way out a quarter of the speed.
    CHECK_THAT(bubble_velocity({0.8 * 0.080, 0, 0}).x(), WithinRel(0.025, 1e-12));
    CHECK_THAT(bubble_velocity({0, -0.9 * 0.060, 0}).y(), WithinRel(-0.05625, 1e-12));
    CHECK_THAT(bubble_velocity({0.080, 0, 0}).x(), WithinRel(0.1, 1e-12));
    CHECK_THAT(bubble_velocity(10 * half).norm(), WithinRel(0.1, 1e-12));

    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 handle = random_place(random), velocity = bubble_velocity(handle);
        const Vec3 inside = handle.cwiseMin(0.6 * half).cwiseMax(-0.6 * half);
        REQUIRE(velocity.norm() <= 0.1 * (1 + 1e-12));
        if ((handle.cwiseAbs() - half).maxCoeff() > 0) continue;
        REQUIRE((velocity.norm() > 0) == (handle != inside));
        REQUIRE(velocity.cross(handle - inside).norm() < 1e-15);
        REQUIRE(velocity.dot(handle - inside) >= 0);
        const Vec3 further_out = inside + 1.01 * (handle - inside);
        REQUIRE(bubble_velocity(further_out).norm() >= velocity.norm() * (1 - 1e-12));
    }
}

TEST_CASE("the bubble's rate is continuous, at its surface and all over", "[haptics][workspace]") {
    CHECK(bubble_velocity(0.6 * half).norm() == 0);
    std::mt19937 random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 from = random_place(random), to = random_place(random);
        // Ways of 0.1 mm or less; the rate changes by 20 per second at most.
        Vec3 before = bubble_velocity(from);
        const int steps = 1 + static_cast<int>((to - from).norm() / 1e-4);
        for (int k = 1; k <= steps; ++k) {
            const Vec3 now = bubble_velocity(from + (to - from) * k / steps);
            REQUIRE((now - before).norm() < 20 * 1e-4);
            before = now;
        }
    }
}

TEST_CASE("drift leaves a hand at rest and a handle at the centre alone", "[haptics][workspace]") {
    CHECK(extra_travel(DriftMap{}, 0.9 * half, Vec3::Zero(), half, servo_tick_s) == Vec3::Zero());
    CHECK(extra_travel(DriftMap{}, Vec3::Zero(), {0.001, 0, 0}, half, servo_tick_s) ==
          Vec3::Zero());
}

TEST_CASE("drift is outward and never more than the hand's own way", "[haptics][workspace]") {
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 handle = random_place(random), moved = 0.01 * random_place(random);
        const Vec3 extra = extra_travel(DriftMap{}, handle, moved, half, servo_tick_s);
        REQUIRE(extra.cwiseProduct(handle).minCoeff() >= 0);
        REQUIRE(extra.norm() < 0.15 * std::numbers::sqrt3 * (1 + 1e-12) * moved.norm());
    }
    const Vec3 at_edge =
        extra_travel(DriftMap{}, {0, 0, -0.035}, {0.001, 0, 0}, half, servo_tick_s);
    CHECK((at_edge - Vec3(0, 0, -0.00015)).norm() < 1e-18);
}

TEST_CASE("drift brings the hand that holds the molecule's place back to the centre",
          "[haptics][workspace]") {
    // The hand moves the molecule to and fro about one place, 5 mm at 1 Hz, and watches only it.
    Vec3 handle(0.040, 0.030, -0.020), molecule = Vec3::Zero();
    const Vec3 start = handle;
    double way = 0;
    for (int i = 1; i <= 20000; ++i) {
        const double place = 0.005 * std::sin(2 * std::numbers::pi * i * servo_tick_s);
        const Vec3 wanted(place, 0, 0);
        const Vec3 moved = wanted - molecule;  // what drift added, this tick takes back
        handle += moved;
        way += moved.norm();
        molecule += moved + extra_travel(DriftMap{}, handle, moved, half, servo_tick_s);
        REQUIRE((molecule - wanted).norm() < 1e-5);
    }

    // d handle = -share (handle/half) d way, axis by axis.
    for (int axis = 0; axis < 3; ++axis) {
        INFO("axis " << axis);
        const double left = std::exp(-0.15 * way / half(axis));
        CHECK(left < 0.6);
        CHECK_THAT(handle(axis) / start(axis), WithinAbs(left, 0.03));
    }
}

TEST_CASE("extra travel has no preferred side", "[haptics][workspace]") {
    const WorkspaceMap map =
        GENERATE(WorkspaceMap(ClutchMap{}), WorkspaceMap(BubbleMap{}), WorkspaceMap(DriftMap{}));
    std::mt19937 random(4);

    for (int i = 0; i < 1000; ++i) {
        const Vec3 handle = random_place(random), moved = 0.01 * random_place(random);
        const Vec3 extra = extra_travel(map, handle, moved, half, servo_tick_s);
        REQUIRE(extra_travel(map, -handle, -moved, half, servo_tick_s) == -extra);
        const Vec3 mirror(-1, 1, 1);
        REQUIRE(extra_travel(map, handle.cwiseProduct(mirror), moved.cwiseProduct(mirror), half,
                             servo_tick_s) == extra.cwiseProduct(mirror));
    }
}

TEST_CASE("extra travel is finite whatever comes in", "[haptics][workspace]") {
    const WorkspaceMap map =
        GENERATE(WorkspaceMap(ClutchMap{}), WorkspaceMap(BubbleMap{}), WorkspaceMap(DriftMap{}));
    const double nan = std::nan(""), infinity = INFINITY;
    const Vec3 zero = Vec3::Zero(), moved(0.001, 0, 0);

    CHECK(extra_travel(map, zero, zero, half, servo_tick_s) == zero);
    CHECK(extra_travel(map, zero, zero, zero, 0) == zero);
    CHECK(extra_travel(map, half, moved, zero, servo_tick_s) == zero);
    CHECK(extra_travel(map, {nan, 0, 0}, moved, half, servo_tick_s) == zero);
    CHECK(extra_travel(map, {infinity, 0, 0}, moved, half, servo_tick_s) == zero);
    CHECK(extra_travel(map, half, {0, nan, 0}, half, nan) == zero);
    CHECK(extra_travel(map, half, {infinity, 0, 0}, half, infinity) == zero);
    // A device along x alone.
    const Vec3 extra = extra_travel(map, {0.08, 1, 1}, moved, {0.08, 0, 0}, servo_tick_s);
    CHECK(extra.y() == 0);
    CHECK(extra.z() == 0);
}
