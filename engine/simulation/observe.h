// What watches steps without taking part: whether forces are exact enough, and how long steps take.
// What they find decides how much work the next steps do.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Before a step, where forces are to be exact: what the servo said where the first hand is, in the
// field of the step before.
void note_rendered_force(World& world, const StepInput& input);

// After it: now and then, or where an accuracy is asked for as often as its share of the work
// allows, the error of the force on the first hand: against a copy that relaxes completely, all
// joints and all pairs, down to an rms force of 0.1 kcal/mol per rad and Å. Steps by second order
// have their own estimate.
void estimate_error(World& world);
// One of these estimates, at once.
void find_error(World& world);

// The step's time, which a time budget goes by.
void note_time(World& world);

}  // namespace palpa
