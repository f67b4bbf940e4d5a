#include "scene/edits.h"
#include "simulation/edits/changes.h"

namespace palpa {

void LetGoEdit::apply(World& world, std::size_t slot) const {
    const Entity hand = find_hand(world, slot);
    edit_whole(world, [&](World& changed) { release(changed, hand); });
}

}  // namespace palpa
