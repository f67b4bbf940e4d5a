// The first of the closed paths that `palpa-lab closed-paths` plays, and that its limits can be
// missed.
#include "tools/lab/experiments/closed_paths.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <tuple>

using namespace palpa;

namespace {

ClosedPathOptions closed_paths(std::size_t count, const std::vector<std::string>& settings = {}) {
    ClosedPathOptions options;
    options.scene = test::in_project("scenes/water/space.toml");
    options.settings = settings;
    options.count = count;
    return options;
}

}  // namespace

TEST_CASE("closed paths in space do the work of the continuous law and end where it ends",
          "[experiments][long]") {
    const std::string shape = GENERATE("scalar", "tensor");
    const std::vector<ClosedPathResult> results =
        play_closed_paths(closed_paths(60, {"gain_shape=" + shape}), {});

    REQUIRE(results.size() == 60);
    for (std::size_t i = 0; i < results.size(); ++i) {
        const ClosedPathResult& r = results[i];
        INFO(shape << " " << i << ": " << r.extra_joule() << " J, " << r.drift_angstrom << " A, "
                   << r.ripple_N << " N, " << r.felt_share);
        CHECK(meets_limits(r, false));
    }
}

// 400 pN are felt as 2.7 N, more than motors stand for long.
TEST_CASE("what is felt strongly keeps its energy too, at the thermal limit as well",
          "[experiments][coupling]") {
    std::size_t limited = 0;
    for (const ClosedPathResult& r :
         play_closed_paths(closed_paths(20, {"coupling.feel_pN=[50, 400]"}), {})) {
        INFO(r.extra_joule() << " J, " << r.drift_angstrom << " A, " << r.clipped_mm << " mm");
        limited += r.was_limited ? 1 : 0;
        CHECK(meets_limits(r, false));
    }
    CHECK(limited > 2);
    CHECK(limited < 15);
}

// In these the hand rests against the wall until the thermal limit, and goes further in when the
// force falls.
TEST_CASE("the thermal limit generates nothing on closed paths", "[experiments][coupling]") {
    const auto [seed, number] =
        GENERATE(table<std::uint64_t, std::size_t>({{4242, 226}, {99, 954}}));
    ClosedPathOptions options = closed_paths(1);
    options.seed = seed;
    options.first = number;
    for (const ClosedPathResult& r : play_closed_paths(options, {})) {
        INFO(r.extra_joule() << " J, " << r.ripple_N << " N, " << r.drift_angstrom << " A");
        CHECK(r.was_limited);
        CHECK(std::abs(r.extra_joule()) < 1e-3);
        CHECK(meets_limits(r, false));
    }
}

// A law with constant gains is conservative: on a closed path it does nothing.
TEST_CASE("constant gains do no work around a way that is brought home",
          "[experiments][coupling]") {
    const std::vector<std::string> constant{"force_law=constant", "A_f=0.3e9",
                                            "displacement_law=constant", "coupling.A_d=1.25e9"};
    for (const ClosedPathResult& r : play_closed_paths(closed_paths(10, constant), {})) {
        CHECK(std::abs(r.closed_law_J) < 1e-6);
        CHECK(r.closure_angstrom < 1e-6);
        CHECK(r.open_mm > 0);
    }
}

TEST_CASE("ways on which the handle turns end without a ripple and under the cap",
          "[experiments][coupling]") {
    ClosedPathOptions options = closed_paths(40);
    options.turn = true;

    for (const ClosedPathResult& result : play_closed_paths(options, {}))
        CHECK(meets_limits(result, true));
}

TEST_CASE("positions read in steps of 1 mm miss the limits of closed paths",
          "[experiments][coupling]") {
    std::size_t missed = 0;
    for (const ClosedPathResult& result :
         play_closed_paths(closed_paths(40, {"device.encoder_step_mm=1"}), {}))
        missed += meets_limits(result, false) ? 0 : 1;

    CHECK(missed > 20);
}
