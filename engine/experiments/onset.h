// Where the paper's loop begins to shake, found by playing it on a linear spring.
#pragma once
#include "haptics/hand.h"

#include <cstdint>

namespace palpa {

// A loop whose handle, without friction and read exactly, is held by that grip.
struct SpringLoop {
    double viscosity_N_s_per_m = 0.1;  // of the device
    HandGrip grip = HandGrip::None;
    std::uint64_t period_ms = 1;
    int delay_ticks = 0;
};

// The felt stiffness K (N/m) at which a small kick is no longer forgotten, by halving in the
// logarithm between one that is calm and one that shakes.
double find_onset(double calm, double shaking, const SpringLoop& loop, int halvings = 7);

}  // namespace palpa
