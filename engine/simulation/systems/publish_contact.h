// Computes the local contact model of every hand: the forces at the present pose of what it holds,
// and the field around it.
#pragma once
#include "ecs/world.h"
#include "simulation/components.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Also measures what part of the change since the last model the frozen field predicted.
void publish_contact(World& world, const StepInput& input);

// The same for one hand.
void update_contact(World& world, Entity hand, const HandPose& pose);

// The model at the present positions; without a prediction checked so far.
LocalContactModel build_local_contact(const World& world, Entity hand, const HandPose& pose);

// Builds the model of a hand again, as of what it holds now; the number of its grip stays.
void renew_contact(World& world, Entity hand);

// The model of a hand that holds nothing: it feels nothing.
LocalContactModel build_still_contact(const World& world);

// Selects the atoms that a servo tick has time for, beside those that other hands hold: the nearest
// to the held molecule. Repeated when it has moved by 0.5 Å, and now and then.
void update_near(World& world, Entity hand);

}  // namespace palpa
