#include "core/ring.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <thread>

TEST_CASE("a ring hands out every value in order, and counts what it has no room for",
          "[core][ring]") {
    palpa::Ring<int, 4> ring;
    int value = -1;
    CHECK_FALSE(ring.pop(value));
    CHECK(value == -1);
    for (int i = 0; i < 6; ++i) CHECK(ring.push(i) == (i < 4));

    for (int i = 0; i < 4; ++i) {
        REQUIRE(ring.pop(value));
        CHECK(value == i);
    }
    CHECK_FALSE(ring.pop(value));
    CHECK(ring.dropped() == 2);
    CHECK(ring.push(7));
    CHECK(ring.pop(value));
    CHECK(value == 7);
}

TEST_CASE("a ring between two threads loses nothing that it took", "[core][ring][mailbox]") {
    constexpr std::uint64_t last = 200'000;
    palpa::Ring<std::uint64_t, 64> ring;

    std::thread pushing([&ring] {
        for (std::uint64_t i = 1; i <= last;) i += ring.push(i) ? 1 : 0;
    });
    std::uint64_t value = 0, expected = 1, wrong = 0;
    while (expected <= last) {
        if (!ring.pop(value)) continue;
        if (value != expected) ++wrong;
        ++expected;
    }
    pushing.join();

    CHECK(wrong == 0);
}
