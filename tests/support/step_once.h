#pragma once
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/step_once.h"

namespace palpa::test {

// One step of a world with one hand, and what that feels then.
inline ContactModel step_once(World& world, const HandPose& hand, const ContactModel& felt) {
    (void)step_world(world, hand, felt);
    return contact_at(world, 0).model;
}

}  // namespace palpa::test
