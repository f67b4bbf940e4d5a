// Input of a step, for each hand in the order of their devices; hands without input stand still.
#pragma once
#include "haptics/exchange.h"

#include <functional>
#include <optional>
#include <span>

namespace palpa {

// `felt`: the contact model in force at the hand; its force sets how far the molecule moves for the
// handle's travel: dx_m = dx_h / A_d(F_m), the paper's incremental coupling with its delay of one
// step. A pose with the molecule's position moves the molecule there.
struct StepInput {
    std::span<const HandPose> hands;
    std::span<const ContactModel> felt;
    std::optional<double> took_us = {};  // wall time of this step when a journal is played
    // With second-order renewals in another thread: whether this step adopts the pending one,
    // waiting for it if needed.
    bool adopts_renewal = false;
    std::function<void()> await_renewal = {};
};

}  // namespace palpa
