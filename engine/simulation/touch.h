// What the hand is told of the molecule in it: forces where it stands, and the field around it.
#pragma once
#include "haptics/exchange.h"
#include "simulation/simulation.h"

namespace palpa {

// Of the molecule where it stands; nothing confirmed or denied yet.
Touch build_touch(const Simulation& simulation, const HandPose& hand) noexcept;

// The simulation's touch after a step, and how much of the way from the last one the frozen field
// foretold.
void update_touch(const HandPose& hand, Simulation& simulation) noexcept;

// The atoms that a servo tick has time for: those that are nearest to the molecule in the hand,
// told by its atoms. Chosen anew when that has moved by half an Å, and now and then.
void update_near(Simulation& simulation) noexcept;

}  // namespace palpa
