// The whole loop, device to simulation to device, with a spring in place of the molecule: where it
// begins to shake must be where theory says.
#include "tools/lab/experiments/onset.h"
#include "haptics/hand.h"
#include "haptics/plant.h"
#include "tests/support/critical_stiffness.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>

using namespace palpa;

TEST_CASE("the emulated loop begins to shake within 5 % of the K that theory gives",
          "[experiments][coupling]") {
    const auto [viscosity, grip, period_ms, K] = GENERATE(from_range(test::critical_stiffness));
    INFO(viscosity << " Ns/m, " << grip_names[static_cast<std::size_t>(grip)] << ", " << period_ms
                   << " ms");

    // Halving K/1.5 ... 1.5 K seven times leaves 0.3 %.
    const double onset = find_onset(K / 1.5, K * 1.5, {viscosity, grip, period_ms});

    CHECK(onset == Approx(K).epsilon(0.05));
}

TEST_CASE("with a delayed servo the emulated loop shakes within 5 % of the K of the delayed theory",
          "[experiments][coupling]") {
    const auto [grip, period_ms, delay_ticks] = GENERATE(table<HandGrip, std::uint64_t, int>({
        {HandGrip::None, 1, 1},
        {HandGrip::Light, 1, 1},
        {HandGrip::Slack, 1, 2},
        {HandGrip::Medium, 5, 1},
        {HandGrip::Medium, 5, 7},
        {HandGrip::Medium, 14, 1},
        {HandGrip::Firm, 14, 3},
        {HandGrip::FirmGrip, 14, 1},
        {HandGrip::Firm, 83, 1},
    }));
    INFO(grip_names[static_cast<std::size_t>(grip)] << ", " << period_ms << " ms, " << delay_ticks);
    const double K =
        palpa::critical_stiffness(build_plant({}, hand_model(grip)),
                                  static_cast<double>(period_ms) * 1e-3, delay_ticks * 1e-3);

    const double onset = find_onset(K / 1.5, K * 1.5, {0.1, grip, period_ms, delay_ticks});

    CHECK(onset == Approx(K).epsilon(0.05));
}
