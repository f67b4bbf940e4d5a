// One step of the simulation: hand pose in, touch model out.
#pragma once
#include "haptics/exchange.h"
#include "simulation/simulation.h"

#include <optional>

namespace palpa {

// What a step found. A step that is not finite has moved nothing; its touch model says what was not
// finite, so that the servo stops, unless it was the hand's pose or on the way to rest.
struct [[nodiscard]] StepReport {
    TouchModel touch;  // for the hand, one period later; with its field it is the simulation's
    double move = 0;   // Å, how far the hand moved what it holds
    std::optional<SettleReport> settled;  // what moved by itself
    bool finite = true;
};

// `felt`: the touch model that the hand feels at this moment; its force decides how far the
// molecule goes for the handle's travel, dx_m = dx_h / A_d(F_m), the paper's incremental coupling
// with its one-step delay. A pose that tells the molecule's place puts it there.
StepReport step_simulation(Simulation& simulation, const HandPose& hand,
                           const TouchModel& felt) noexcept;

// The hand takes hold of the molecule where both are: what the handle travelled since the last step
// moves nothing.
void take_hold(Simulation& simulation, const HandPose& hand) noexcept;

}  // namespace palpa
