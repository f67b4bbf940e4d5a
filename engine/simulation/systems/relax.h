// Relaxes mobile joints and bases on CHARMM forces.
#pragma once
#include "ecs/world.h"
#include "simulation/resources.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Makes the solver's number of steps with the active joints and bases.
void relax(World& world, const StepInput& input);

// The same, for measurements outside of a step.
RelaxStepReport relax_mobile(World& world, const StepInput& input);

}  // namespace palpa
