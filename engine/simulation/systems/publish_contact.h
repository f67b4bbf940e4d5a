// The local contact model of every hand: forces where what it holds stands, and the field around
// it.
#pragma once
#include "ecs/world.h"
#include "simulation/components.h"
#include "simulation/systems/step_input.h"

namespace palpa {

// Also how much of the way from the last model the frozen field predicted.
void publish_contact(World& world, const StepInput& input);

// The same for one hand.
void update_contact(World& world, Entity hand, const HandPose& pose);

// Where things stand; nothing predicted has been confirmed or denied yet.
LocalContactModel build_local_contact(const World& world, Entity hand, const HandPose& pose);

// The atoms that a servo tick has time for beside those that other hands hold: the nearest to the
// molecule in the hand.
// Chosen anew when that has moved by half an Å, and now and then.
void update_near(World& world, Entity hand);

}  // namespace palpa
