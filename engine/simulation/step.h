// One step of the simulation: hand poses in, contact models out.
#pragma once
#include "ecs/world.h"
#include "simulation/resources.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Every system in its order (step.cpp has the list), for a world as load_world makes it; its
// StepReport. A step that ends in something not finite leaves what moves as it was; where a contact
// force is no number, its contact model says so, and the servo stops.
const StepReport& step_world(World& world, const StepInput& input) noexcept;

// Of the first hand; others stand still.
const StepReport& step_world(World& world, const HandPose& hand, const ContactModel& felt) noexcept;

}  // namespace palpa
