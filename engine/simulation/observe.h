// Observes steps: the error of forces and the time of steps. The results decide how much work the
// next steps do.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Before a step, if an accuracy is set: records the force that the servo rendered at the first
// hand's present pose, in the field of the previous step.
void note_rendered_force(World& world, const StepInput& input);

// After a step: estimates the error of the force on the first hand, now and then, or, if an
// accuracy is set, as often as its share of the work allows. Compares with a copy relaxed
// completely, with all joints and pairs, to an rms force of 0.1 kcal/mol per rad and Å.
// Second-order steps have their own estimate.
void estimate_error(World& world);
// Makes one such estimate at once.
void find_error(World& world);

// Records the time of the step, for a time budget.
void note_time(World& world);

}  // namespace palpa
