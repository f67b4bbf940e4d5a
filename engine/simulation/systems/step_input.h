// What a step is given, of each hand in the order of their devices; hands beyond these stand still.
#pragma once
#include "haptics/exchange.h"

#include <functional>
#include <optional>
#include <span>

namespace palpa {

// `felt`: the contact model that the hand feels at this moment; its force decides how far the
// molecule goes for the handle's travel, dx_m = dx_h / A_d(F_m), the paper's incremental coupling
// with its one-step delay. A pose that gives the molecule's place puts it there.
struct StepInput {
    std::span<const HandPose> hands;
    std::span<const ContactModel> felt;
    std::optional<double> took_us = {};  // wall time of this step, where it is played again
    // Where a thread of its own makes renewals of second order: whether this step begins with the
    // pending one; and waits for that thread.
    bool adopts_renewal = false;
    std::function<void()> await_renewal = {};
};

}  // namespace palpa
