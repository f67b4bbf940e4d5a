#include "platform/thread.h"

#include <catch2/catch.hpp>

using namespace palpa;
using Clock = std::chrono::steady_clock;

TEST_CASE("a thread never wakes before the moment that it sleeps until", "[platform]") {
    for (const int us : {-1000, 0, 1, 150, 999, 2500}) {
        const Clock::time_point moment = Clock::now() + std::chrono::microseconds(us);
        sleep_exactly_until(moment);
        CHECK(Clock::now() >= moment);
        wait_awake_until(moment);
        CHECK(Clock::now() >= moment);
    }
}
