#include "molecule/point_grid.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace palpa;

namespace {

std::vector<std::uint32_t> visited(const PointGrid& grid, const Vec3& place, double radius) {
    std::vector<std::uint32_t> found;
    grid.visit_near(place, radius, [&](std::uint32_t point) { found.push_back(point); });
    std::ranges::sort(found);
    return found;
}

}  // namespace

TEST_CASE("a grid finds the points that looking at all finds", "[molecule][grid]") {
    std::mt19937 random(3);  // NOLINT(cert-msc51-cpp): the same on every run
    const double spread = GENERATE(0.0, 1.0, 30.0, 1e6);
    const double edge = GENERATE(0.5, 5.0, 100.0);
    const double radius = GENERATE(0.3, 4.0, 50.0);
    std::uniform_real_distribution<double> along(-spread, spread);
    std::vector<Vec3> points(300);
    for (Vec3& point : points) point = {along(random), 0.1 * along(random), along(random)};
    const PointGrid grid(points, edge);
    CAPTURE(spread, edge, radius);

    for (int i = 0; i < 100; ++i) {
        const Vec3 place(1.3 * along(random), along(random), along(random));
        std::vector<std::uint32_t> expected;
        for (std::uint32_t p = 0; p < points.size(); ++p)
            if ((points[p] - place).norm() <= radius) expected.push_back(p);
        CHECK(visited(grid, place, radius) == expected);
        CHECK(grid.has_near(place, radius) == !expected.empty());
    }
}

TEST_CASE("points far apart, nowhere or none at all are no harm", "[molecule][grid]") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const PointGrid far({{0, 0, 0}, {1e15, 0, 0}, {nan, 0, 0}, {0, infinite, 0}, {1e200, 0, 0}});
    const PointGrid none(std::vector<Vec3>{});

    CHECK(visited(far, {1e15, 0.5, 0}, 1) == std::vector<std::uint32_t>{1});
    CHECK(visited(far, {0, 0, 1}, 1) == std::vector<std::uint32_t>{0});
    CHECK_FALSE(far.has_near({nan, 0, 0}, 1e9));
    CHECK_FALSE(far.has_near({0, 0, -infinite}, 1));
    CHECK_FALSE(none.has_near({0, 0, 0}, 1e9));
}
