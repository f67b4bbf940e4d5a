// The atoms that are shown as held.
#pragma once
#include "ecs/world.h"

#include <vector>

namespace palpa {

// One entry per atom: whole molecules, or the atoms held by a spring.
std::vector<bool> find_held_atoms(const World& world);

// The same, with the whole molecule of the first hand.
std::vector<bool> find_in_hand(const World& world);

}  // namespace palpa
