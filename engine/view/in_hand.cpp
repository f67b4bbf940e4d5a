#include "view/in_hand.h"

#include "simulation/grip_queries.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace palpa {

std::vector<bool> find_held_atoms(const World& world) {
    std::vector<bool> held(world.resource<AtomTable>().size(), false);
    for (const Entity hand : find_hands(world)) {
        for (const std::uint32_t atom : held_atoms(world, hand)) held[atom] = true;
    }
    return held;
}

std::vector<bool> find_in_hand(const World& world) {
    std::vector<bool> in_hand = find_held_atoms(world);
    const AtomRange first = held_range(world, hand_at(world, 0));
    std::fill_n(in_hand.begin() + static_cast<std::ptrdiff_t>(first.first), first.count, true);
    return in_hand;
}

}  // namespace palpa
