// Finds the stability limit of the paper's loop by playing it on a linear spring.
#pragma once
#include "haptics/hand.h"

#include <cstdint>

namespace palpa {

// A loop with a handle without friction and with exact sensors, held by this grip.
struct SpringLoop {
    double viscosity_N_s_per_m = 0.1;  // viscosity of the device
    HandGrip grip = HandGrip::None;
    std::uint64_t period_ms = 1;
    int delay_ticks = 0;
};

// The stiffness K (N/m) at which a small impulse no longer decays, by bisection in the logarithm
// between a stable and a vibrating value.
double find_onset(double calm, double shaking, const SpringLoop& loop, int halvings = 7);

}  // namespace palpa
