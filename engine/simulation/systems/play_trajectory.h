// The system that plays a trajectory (simulation/playback.h).
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Writes the due frame to the atom table and moves what hands hold to it. Does nothing without
// playback. Playback stops while a spring or anything else moves molecules, and while edits have
// changed the number of atoms.
void play_trajectory(World& world, const StepInput& input);

}  // namespace palpa
