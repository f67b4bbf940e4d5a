#include "tools/lab/experiments/onset.h"

#include "devices/emulated_omni.h"
#include "haptics/servo.h"
#include "session/lockstep.h"

#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

constexpr double A_f = 0.25e9, A_d = 0.25e9;  // so that the spring felt is the spring itself

// Whether a handle on a spring of K (N/m) shakes ever more after a small kick.
bool shakes(double K, const SpringLoop& loop) {
    EmulatedOmniSettings settings;
    settings.dynamics.viscosity_N_s_per_m = loop.viscosity_N_s_per_m;
    settings.friction_newton = 0;
    settings.encoder_step_m = 0;
    settings.hand = hand_model(loop.grip);
    settings.script.kick_N_s = 1e-6;
    settings.script.path = {{0, 0}};
    EmulatedOmni omni(settings);
    const ServoSettings servo{ConstantForceLaw{A_f}, {.is_full = false}, loop.delay_ticks};

    double molecule_m = 0, travel = 0;
    const auto step = [&](const HandPose& hand, const ContactModel&) {
        molecule_m += (hand.travel_m.x() - travel) / A_d;
        travel = hand.travel_m.x();
        ContactModel contact;
        contact.force_newton.x() = -K * molecule_m;
        return contact;
    };
    // Loud in an early window against loud in a late one, both many swings long. The kick itself
    // moves the handle by microns; what is far above has grown, to its limit even.
    constexpr double far_m = 1e-4;
    double early = 0, late = 0;
    const auto on_tick = [&](const ServoTick& tick) {
        const double x = std::abs(tick.reading.position_m.x());
        const double t = tick.reading.time_s;
        if (t > 3 && t < 9) early = std::max(early, x);
        if (t > 34) late = std::max(late, x);
    };
    run_lockstep({40'000, loop.period_ms}, servo, omni, {}, step, on_tick,
                 [&] { return early > far_m; });
    return late > early || early > far_m;
}

}  // namespace

double find_onset(double calm, double shaking, const SpringLoop& loop, int halvings) {
    for (int halving = 0; halving < halvings; ++halving) {
        const double K = std::sqrt(calm * shaking);
        (shakes(K, loop) ? shaking : calm) = K;
    }
    return std::sqrt(calm * shaking);
}

}  // namespace palpa
