// Adaptive selection of the degrees of freedom that move in a step.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Sets how many degrees of freedom may be active, their weights, and when they are selected next.
// Relaxation, which has the accelerations, makes the selection itself.
void choose_active(World& world, const StepInput& input);

// The same for a selection in this step.
void prepare_choice(World& world);

}  // namespace palpa
