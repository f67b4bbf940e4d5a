// Moves the atoms to a remote engine's newest frame and applies the forces of the hands.
#pragma once
#include "ecs/world.h"
#include "simulation/remote_engine.h"

namespace palpa {

// Atoms go to the positions of the engine's newest frame; the spring of each hand follows the
// low-pass filtered centre of the held atoms, and its force goes to the engine. While no frames
// arrive, and when held atoms jump to another periodic image, there is no force; the hand then
// grips again at the atoms' positions.
void follow_engine(World& world, RemoteEngine& engine);

// Before the first step with a remote engine: waits for the first frame and moves the hands to what
// they hold. Throws EngineLost.
void begin_with_engine(World& world);

}  // namespace palpa
