#include "devices/rate_handle.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using namespace palpa;

namespace {

constexpr double tick_s = 1e-3;
constexpr double no_rate = std::numeric_limits<double>::quiet_NaN();
constexpr double endless = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a dead zone takes nothing from the end of the way", "[devices][rate-handle]") {
    CHECK(beyond_dead_zone(0, 0.1) == 0);
    CHECK(beyond_dead_zone(0.1, 0.1) == 0);
    CHECK(beyond_dead_zone(-0.1, 0.1) == 0);
    CHECK(beyond_dead_zone(0.55, 0.1) == Approx(0.5));
    CHECK(beyond_dead_zone(-0.55, 0.1) == Approx(-0.5));
    CHECK(beyond_dead_zone(1, 0.1) == 1);
    CHECK(beyond_dead_zone(-7, 0.1) == -1);
    CHECK(beyond_dead_zone(no_rate, 0.1) == 0);
    CHECK(beyond_dead_zone(endless, 0.1) == 1);
}

TEST_CASE("a rate is where it leads after its time", "[devices][rate-handle]") {
    RateHandle handle;

    for (int i = 0; i < 1000; ++i) handle.move({Vec3(0.03, -0.02, 0.01), Vec3::Zero()}, tick_s);

    CHECK((handle.position_m() - Vec3(0.03, -0.02, 0.01)).norm() < 1e-12);
    CHECK(handle.orientation().angularDistance(Quat::Identity()) == 0);
}

TEST_CASE("turns are about the axes of the box, whichever way the handle looks",
          "[devices][rate-handle]") {
    constexpr double quarter = std::numbers::pi / 2;
    RateHandle handle;

    for (int i = 0; i < 1000; ++i) handle.move({Vec3::Zero(), Vec3(0, quarter, 0)}, tick_s);
    for (int i = 0; i < 1000; ++i) handle.move({Vec3::Zero(), Vec3(quarter, 0, 0)}, tick_s);

    // About y its z comes to lie along x, where the turn about x leaves it.
    CHECK((handle.orientation() * Vec3::UnitZ() - Vec3::UnitX()).norm() < 1e-9);
    CHECK((handle.orientation() * Vec3::UnitY() - Vec3::UnitZ()).norm() < 1e-9);
    CHECK(handle.position_m() == Vec3::Zero());
}

TEST_CASE("at a side of its box a handle slides along it, and comes away at once",
          "[devices][rate-handle]") {
    constexpr double half = RateHandle::half_box_m;
    RateHandle handle;

    for (int i = 0; i < 1000; ++i) handle.move({Vec3(0.2, 0.01, 0), Vec3::Zero()}, tick_s);
    const Vec3 at_side = handle.position_m();
    handle.move({Vec3(-0.2, 0, 0), Vec3::Zero()}, tick_s);

    CHECK(at_side.x() == half);
    CHECK(at_side.y() == Approx(0.01));
    CHECK(handle.position_m().x() == Approx(half - 0.2e-3));
}

TEST_CASE("no rate takes a handle further than it may go in a tick", "[devices][rate-handle]") {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> exponent(-320, 308);
    const auto any = [&] {
        const auto kind = random() % 20;
        if (kind == 0) return no_rate;
        if (kind == 1) return endless;
        return std::pow(10.0, exponent(random)) * (kind % 2 == 0 ? 1 : -1);
    };
    RateHandle handle;
    double farthest_m = 0, farthest_rad = 0;

    for (int i = 0; i < 100'000; ++i) {
        const RateHandle before = handle;
        handle.move({{any(), any(), any()}, {any(), any(), any()}}, tick_s);
        REQUIRE(handle.position_m().allFinite());
        REQUIRE(std::abs(handle.orientation().norm() - 1) < 1e-12);
        farthest_m = std::max(farthest_m, (handle.position_m() - before.position_m()).norm());
        farthest_rad =
            std::max(farthest_rad, handle.orientation().angularDistance(before.orientation()));
    }

    CHECK(farthest_m <= RateHandle::fastest_m_per_s * tick_s * (1 + 1e-12));
    CHECK(farthest_m > 0.9 * RateHandle::fastest_m_per_s * tick_s);
    CHECK(farthest_rad <= RateHandle::fastest_rad_per_s * tick_s * (1 + 1e-6));
    CHECK(farthest_rad > 0.9 * RateHandle::fastest_rad_per_s * tick_s);
}

TEST_CASE("a handle returns to the middle straight on, keeps its turn, and stays",
          "[devices][rate-handle]") {
    RateHandle handle;
    for (int i = 0; i < 100; ++i) handle.move({Vec3(0.3, 0.1, 0), Vec3(0, 0, 1)}, tick_s);
    const Quat turned = handle.orientation();
    const Vec3 from = handle.position_m();

    handle.return_to_middle(tick_s);
    const Vec3 first = from - handle.position_m();
    for (int i = 0; i < 200; ++i) handle.return_to_middle(tick_s);

    CHECK((first - RateHandle::return_m_per_s * tick_s * from.normalized()).norm() < 1e-12);
    CHECK(handle.position_m().norm() < 1e-12);
    CHECK(handle.orientation().angularDistance(turned) == 0);
}
