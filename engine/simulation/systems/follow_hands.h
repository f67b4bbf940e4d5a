// Moves what hands hold.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Moves what each hand holds, or its end of the spring, to the hand's pose (eq. 3 of the paper, or
// the pose set by guarded coupling). If a pose is not finite, no hand moves anything, and the step
// counts as not finite.
void follow_hands(World& world, const StepInput& input);

// The hand grips at the present poses: the handle's travel since the last step moves nothing.
void begin_grip(World& world, Entity hand, const HandPose& pose) noexcept;

}  // namespace palpa
