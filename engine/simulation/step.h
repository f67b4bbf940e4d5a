// One step of the simulation: from hand poses to contact models.
#pragma once
#include "ecs/world.h"
#include "simulation/resources.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Runs all systems in the order listed in step.cpp on a world from load_world and returns its
// StepReport. A step with a result that is not finite moves nothing; a contact model with such a
// force says so, and the servo stops.
const StepReport& step_world(World& world, const StepInput& input) noexcept;

// Takes a pose for the first hand; other hands stand still.
const StepReport& step_world(World& world, const HandPose& hand, const ContactModel& felt) noexcept;

}  // namespace palpa
