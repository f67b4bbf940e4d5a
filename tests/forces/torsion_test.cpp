#include "forces/torsion.h"

#include "tests/support/check_forces.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace palpa;

namespace {

constexpr double degree = std::numbers::pi / 180;

// Looking from b to c, along -z, with d turned clockwise from a by `angle`.
Torsion turned(double angle) {
    return evaluate_torsion({0.3, 1, 0.2}, {0.3, 0, 0}, {0.3, 0, -1.5},
                            {0.3 + std::sin(angle), std::cos(angle), -1.7});
}

}  // namespace

TEST_CASE("a dihedral angle counts from cis, clockwise positive", "[forces][torsion]") {
    for (const double angle : {0.0, 1.0, 60.0, 90.0, 120.0, 179.0, -1.0, -90.0, -179.0}) {
        INFO(angle << " degrees");
        CHECK(turned(angle * degree).angle == Approx(angle * degree).margin(1e-15));
    }
    CHECK(std::abs(turned(180 * degree).angle) == Approx(std::numbers::pi));
}

TEST_CASE("the gradient of a dihedral angle is its derivative", "[forces][torsion]") {
    std::mt19937 random(3);
    for (int round = 0; round < 20; ++round) {
        INFO("round " << round);
        const auto energy = [](std::span<const Vec3> x, std::span<Vec3> forces) {
            const Torsion torsion = evaluate_torsion(x[0], x[1], x[2], x[3]);
            for (std::size_t i = 0; i < 4; ++i) forces[i] -= torsion.gradient[i];
            return torsion.angle;
        };
        test::check_forces(energy, test::random_positions(random, 4, 1.5, 0.8));
    }
}

TEST_CASE("the gradient is bounded on the way to three atoms in line, and zero there",
          "[forces][torsion]") {
    const auto bent = [](double off) {
        return evaluate_torsion({off, 0, 1.5}, {0, 0, 0}, {0, 0, -1.5}, {0, 1.4, -2});
    };

    for (double off = 1; off > 1e-20; off /= 3) {
        INFO(off << " Å off the line");
        double largest = 0;
        for (const Vec3& gradient : bent(off).gradient) {
            largest = std::max(largest, gradient.norm());
        }
        CHECK(largest <= 2 * 1.5 / torsion_guard);
        // Ten times outside of the guard it is what geometry says.
        if (1.5 * off > 10 * torsion_guard) {
            CHECK(bent(off).gradient[0].norm() == Approx(1 / off).epsilon(1e-12));
        }
    }
    for (const Vec3& gradient : bent(0).gradient) CHECK(gradient == Vec3(Vec3::Zero()));
    CHECK(std::isfinite(bent(0).angle));
}

TEST_CASE("a dihedral with atoms at one place is finite", "[forces][torsion]") {
    const double tiny =
        GENERATE(0.0, std::numeric_limits<double>::denorm_min(), 1e-200, 1e-160, 1e-100, 1e-10);
    const int which = GENERATE(0, 1, 2, 3, 4);
    std::vector<Vec3> x{{1, 1, 0}, {0, 0, 0}, {0, 0, -1.5}, {1, -1, -2}};
    // Two of them, or all.
    if (which < 3) x[which + 1] = x[which] + Vec3(tiny, 2 * tiny, -tiny);
    if (which == 3) x[3] = x[0] + Vec3(tiny, 0, 0);
    if (which == 4) x = {{tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}, {0, 0, 0}};

    const Torsion torsion = evaluate_torsion(x[0], x[1], x[2], x[3]);

    CHECK(std::isfinite(torsion.angle));
    for (const Vec3& gradient : torsion.gradient) CHECK(gradient.allFinite());
}
