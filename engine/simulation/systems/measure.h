// Measurements of a world after a step.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Counts the step, checks that the force on every hand is finite, and updates the measurements.
void measure(World& world, const StepInput& input);

}  // namespace palpa
