#include "experiments/latency.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

using namespace palpa;

TEST_CASE("latencies fall into bins that double in width", "[experiments][latency]") {
    const std::vector<LatencyBin> bins = bin_latencies({0, 0.99, 1, 1.5, 2, 7.9, 8});

    REQUIRE(bins.size() == 5);
    const std::vector<double> below_us{1, 2, 4, 8, 16};
    const std::vector<std::uint64_t> ticks{2, 2, 1, 1, 1};
    for (std::size_t i = 0; i < bins.size(); ++i) {
        CHECK(bins[i].below_us == below_us[i]);
        CHECK(bins[i].ticks == ticks[i]);
    }
}

TEST_CASE("no tick begins early, and each is counted, whatever the priority",
          "[experiments][latency]") {
    const bool asks = GENERATE(false, true);

    const WakeUps found = measure_wake_ups(30, asks);

    CHECK(found.late_us.size() + found.missed >= 30);
    REQUIRE(found.late_us.size() <= 30);
    CHECK(std::ranges::all_of(found.late_us, [](double late) { return late >= 0; }));
    CHECK((asks || !found.is_real_time));
}
