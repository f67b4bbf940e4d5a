// A remote engine's newest frame moves the atoms, and hands pull at them.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Where the world has a remote engine: atoms go where its newest frame has them; each hand's spring
// follows the low-passed middle of what it holds, and its force goes to the engine. While frames do
// not come, and where what is held jumps (into another image of a periodic box), there is no force,
// and the hand then takes hold anew where its atoms are.
void follow_engine(World& world, const StepInput& input);

// Before the first step: waits for the first frame, and puts hands where it has what they hold.
// Throws EngineLost.
void begin_with_engine(World& world);

}  // namespace palpa
