// What can be read of a world after a step.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Counts the step, says whether every hand's force is a number, and measures marks.
void measure(World& world, const StepInput& input);

}  // namespace palpa
