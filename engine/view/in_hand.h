// Which atoms are shown as those in hands.
#pragma once
#include "ecs/world.h"

#include <vector>

namespace palpa {

// By number: whole molecules, or what of them is held by a spring.
std::vector<bool> find_held_atoms(const World& world);

// The same, with all of the molecule in the first hand.
std::vector<bool> find_in_hand(const World& world);

}  // namespace palpa
