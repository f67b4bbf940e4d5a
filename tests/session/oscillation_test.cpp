// The paper's coupling on the dimer with one servo tick of delay: reference values computed by
// another program for the same hand, device and kick.
#include "tests/support/water_run.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Matchers::WithinAbs;

namespace {

std::vector<std::string> held(const std::string& period_ms, const std::string& hand,
                              const std::string& friction = "0") {
    return {"mode=2",      "period_ms=" + period_ms, "grip=" + hand, "friction_N=" + friction,
            "stroke=hold", "kick_N_s=0.005",         "seconds=10"};
}

}  // namespace

TEST_CASE("held at rest, the plain loop at 14 ms oscillates in a medium hand",
          "[session][coupling]") {
    const Summary summary = test::run_water(held("14", "medium"));

    CHECK_THAT(summary.ripple->rms, WithinAbs(1.08, 0.1));
    CHECK_THAT(summary.ripple->hertz, WithinAbs(6.6, 0.4));
    REQUIRE(summary.warnings.size() == 1);
    CHECK_THAT(summary.warnings[0], Catch::Matchers::Contains("vibrates"));
}

TEST_CASE("held at rest, the plain loop's ripple follows the period", "[session][coupling]") {
    CHECK(test::run_water(held("1", "medium")).ripple->rms < 0.02);
    CHECK_THAT(test::run_water(held("5", "medium")).ripple->rms, WithinAbs(0.485, 0.05));
    CHECK_THAT(test::run_water(held("83", "medium")).ripple->rms, WithinAbs(1.32, 0.15));
}

TEST_CASE("enough friction stops the shaking of a firm hand at 14 ms", "[session][coupling]") {
    CHECK(test::run_water(held("14", "firm", "0.26")).ripple->rms < 0.02);
}

TEST_CASE("mode 2 at 1 ms is calm, and the attraction of 0.322 nN is felt as 0.896 N",
          "[session][coupling]") {
    const Summary summary = test::run_water({"mode=2"});

    CHECK(summary.ripple->rms < 0.02);
    CHECK_THAT(summary.largest_attraction_N, WithinAbs(0.896, 0.01));
    // In to 3 nN, which eq. 2 plays as 2.12 N; friction keeps up to 0.26 N of the last bit.
    CHECK(summary.largest_repulsion_N > 1.86);
    CHECK(summary.largest_repulsion_N < 2.15);
    CHECK(summary.clamped_share == 0);
    CHECK(summary.steps == 10'000);
    CHECK(summary.warnings.empty());
}

TEST_CASE("without force feedback nothing is felt", "[session][coupling]") {
    const Summary summary = test::run_water({"mode=5"});

    CHECK(summary.largest_attraction_N == 0);
    CHECK(summary.largest_repulsion_N == 0);
    CHECK(summary.net_work_J == 0);
}
