#include "haptics/hand.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace palpa;

TEST_CASE("a minimum-jerk curve starts and ends at rest", "[haptics][hand]") {
    CHECK(minimum_jerk(-1) == 0);
    CHECK(minimum_jerk(0) == 0);
    CHECK(minimum_jerk(0.5) == 0.5);
    CHECK(minimum_jerk(1) == 1);
    CHECK(minimum_jerk(2) == 1);
    // Speed 30 s²(1-s)² and its slope vanish at both ends: the first millimetre takes s³.
    CHECK(minimum_jerk(1e-3) == Approx(1e-8).epsilon(2e-3));
    CHECK(1 - minimum_jerk(1 - 1e-3) == Approx(1e-8).epsilon(2e-3));
}

TEST_CASE("a hand rests before its first waypoint and after its last", "[haptics][hand]") {
    const std::vector<HandWaypoint> path{{1, 0.05}, {3, -0.05}, {4, -0.05}};

    CHECK(find_target(path, 0).place_m.x() == 0.05);
    CHECK(find_target(path, 1).place_m.x() == 0.05);
    CHECK(find_target(path, 2).place_m.x() == Approx(0).margin(1e-15));
    CHECK(find_target(path, 3.5).place_m.x() == -0.05);
    CHECK(find_target(path, 100).place_m.x() == -0.05);
    CHECK(find_target({}, 1).place_m.x() == 0);
}

TEST_CASE("a grip and the hand behind it are springs in a row", "[haptics][hand]") {
    CHECK(static_stiffness(*hand_model(HandGrip::Medium)) == 200);
    // 500 and 1000 N/m in a row
    CHECK(static_stiffness(*hand_model(HandGrip::FirmGrip)) == Approx(1000.0 / 3));
    CHECK_FALSE(hand_model(HandGrip::None).has_value());
}
