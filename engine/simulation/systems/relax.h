// Moves what moves by itself.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Makes the step of the world's solver (simulation/solver.h): mobile joints and bases move towards
// rest on CHARMM forces, or all atoms to the newest frame of a remote engine.
void relax(World& world, const StepInput& input);

}  // namespace palpa
