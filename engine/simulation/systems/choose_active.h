// Adaptive choice of the degrees of freedom that move in a step.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// How many may be active, how much each counts, and when they are chosen next, where this step
// chooses. The choice itself is the first part of relaxation, which has the accelerations.
void choose_active(World& world, const StepInput& input);

// The same for a choice now.
void prepare_choice(World& world);

}  // namespace palpa
