#pragma once
#include "ecs/world.h"

#include <string>

namespace palpa::test {

// Every bit of a world that later steps read: atoms, molecules, hands and what they hold, springs,
// coordinates, positions and forces, coupling, what steps remember; and how molecules are drawn.
// Not the clock, the handle and which start a contact is of.
std::string world_bytes(const World& world);

}  // namespace palpa::test
