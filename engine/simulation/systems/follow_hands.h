// Hands move what they hold.
#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Each hand's pose becomes that of what it holds, or of its end of the spring (the paper's eq. 3,
// or where guarded coupling has put it). A hand that is nowhere moves nothing, nor do the others:
// the step is not finite.
void follow_hands(World& world, const StepInput& input);

// The hand takes hold where both are: what the handle travelled since the last step moves nothing.
void take_hold(World& world, Entity hand, const HandPose& pose) noexcept;

}  // namespace palpa
