// The system that plays a trajectory (simulation/playback.h).
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Puts the frame that is due into the atom table, and what hands hold where it has it. Nothing
// where nothing is played. It stands still while a spring, or anything else, makes molecules move
// by themselves, and while edits have left another number of atoms.
void play_trajectory(World& world, const StepInput& input);

}  // namespace palpa
