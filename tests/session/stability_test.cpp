// The whole loop, device to simulation to device, with a spring in place of the molecule: where it
// begins to shake must be where theory says.
#include "devices/emulated_omni.h"
#include "haptics/gains.h"
#include "session/lockstep.h"
#include "tests/support/critical_stiffness.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>

using namespace palpa;

namespace {

constexpr double A_f = 0.25e9, A_d = 0.25e9;  // so that the spring felt is the spring itself

// Whether a handle on a spring of K (N/m) shakes ever more after a small kick.
bool shakes(double K, double viscosity, Grip grip, std::uint64_t period_ms, int delay_ticks) {
    EmulatedOmniSettings settings;
    settings.dynamics.viscosity_N_s_per_m = viscosity;
    settings.friction_newton = 0;
    settings.encoder_step_m = 0;
    settings.hand = hand_model(grip);
    settings.script.kick_N_s = 1e-6;
    settings.script.path = {{0, 0}};
    EmulatedOmni omni(settings);
    const ServoSettings servo{ConstantForceLaw{A_f}, {.is_full = false}, delay_ticks};

    double molecule_m = 0, travel = 0;
    const auto step = [&](const HandPose& hand, const TouchModel&) {
        molecule_m += (hand.travel_m.x() - travel) / A_d;
        travel = hand.travel_m.x();
        TouchModel touch;
        touch.force_newton.x() = -K * molecule_m;
        return touch;
    };
    // Loud in an early window against loud in a late one, both many swings long.
    double early = 0, late = 0;
    const auto on_tick = [&](const ServoTick& tick) {
        const double x = std::abs(tick.reading.position_m.x());
        const double t = tick.reading.time_s;
        if (t > 3 && t < 9) early = std::max(early, x);
        if (t > 34) late = std::max(late, x);
    };
    run_lockstep({40'000, period_ms}, servo, omni, {}, step, on_tick);
    // The kick itself moves the handle by microns; what is far above has grown, to its limit even.
    return late > early || early > 1e-4;
}

// The K at which shaking begins, by halving between `calm` and `shaking`.
double find_onset(double calm, double shaking, double viscosity, Grip grip, std::uint64_t period_ms,
                  int delay_ticks = 0) {
    for (int halving = 0; halving < 7; ++halving) {
        const double K = std::sqrt(calm * shaking);
        (shakes(K, viscosity, grip, period_ms, delay_ticks) ? shaking : calm) = K;
    }
    return std::sqrt(calm * shaking);
}

}  // namespace

TEST_CASE("the emulated loop begins to shake within 5 % of the K that theory gives",
          "[session][coupling]") {
    const auto [viscosity, grip, period_ms, K] = GENERATE(from_range(test::critical_stiffness));
    INFO(viscosity << " Ns/m, " << grip_names[static_cast<std::size_t>(grip)] << ", " << period_ms
                   << " ms");

    // Halving K/1.5 ... 1.5 K seven times leaves 0.3 %.
    const double onset = find_onset(K / 1.5, K * 1.5, viscosity, grip, period_ms);

    CHECK(onset == Approx(K).epsilon(0.05));
}

TEST_CASE("with a delayed servo the emulated loop shakes within 5 % of the K of the delayed theory",
          "[session][coupling]") {
    const auto [grip, period_ms, delay_ticks] = GENERATE(table<Grip, std::uint64_t, int>({
        {Grip::None, 1, 1},
        {Grip::Light, 1, 1},
        {Grip::Slack, 1, 2},
        {Grip::Medium, 5, 1},
        {Grip::Medium, 5, 7},
        {Grip::Medium, 14, 1},
        {Grip::Firm, 14, 3},
        {Grip::FirmGrip, 14, 1},
        {Grip::Firm, 83, 1},
    }));
    INFO(grip_names[static_cast<std::size_t>(grip)] << ", " << period_ms << " ms, " << delay_ticks);
    const double K =
        palpa::critical_stiffness(build_plant({}, hand_model(grip)),
                                  static_cast<double>(period_ms) * 1e-3, delay_ticks * 1e-3);

    const double onset = find_onset(K / 1.5, K * 1.5, 0.1, grip, period_ms, delay_ticks);

    CHECK(onset == Approx(K).epsilon(0.05));
}
