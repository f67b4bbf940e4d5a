#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// A component of the entity that owns the wind's springs.
struct Wind {};

// Pushes every water that moves by itself and that no hand holds along x.
void blow_wind(World& world, const StepInput& input);

}  // namespace palpa
