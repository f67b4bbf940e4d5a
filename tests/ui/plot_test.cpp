#include "ui/plot.h"

#include "ui/history.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace palpa;

TEST_CASE("ticks are round numbers inside the range", "[ui]") {
    CHECK(round_ticks({0, 10}, 5) == std::vector<double>{0, 2, 4, 6, 8, 10});
    CHECK(round_ticks({-0.3, 0.31}, 3) == std::vector<double>{-0.2, 0, 0.2});
    CHECK(round_ticks({3e9, 7e9}, 4) == std::vector<double>{3e9, 4e9, 5e9, 6e9, 7e9});
    CHECK(round_ticks({1, 1}, 4).empty());
    CHECK(round_ticks({0, 1e308 * 10}, 4).empty());
}

TEST_CASE("a range has room for all values, and is never too narrow", "[ui]") {
    const std::vector<double> values{1, 3, 2};
    CHECK(range_around(values, 0.1).low == Approx(2 - 1.1));
    CHECK(range_around(values, 0.1).high == Approx(2 + 1.1));
    CHECK(range_around(values, 10).high == Approx(7));
    CHECK(range_around({}, 4).low == -2);
}

TEST_CASE("history keeps the last ten seconds, one tick of ten", "[ui]") {
    History history;
    for (int tick = 0; tick < 25'000; ++tick) {
        Reading reading;
        reading.time_s = tick * 1e-3;
        history.add(reading);
    }
    REQUIRE(history.samples().size() == 1000);
    CHECK(history.samples().front().time_s == Approx(15.0));
    CHECK(history.samples().back().time_s == Approx(24.99));

    // Another device's clock.
    for (int tick = 0; tick < 100; ++tick) {
        Reading reading;
        reading.time_s = 1e-3 * tick;
        history.add(reading);
    }
    REQUIRE(history.samples().size() == 10);
    CHECK(history.samples().front().time_s == 0);
}
