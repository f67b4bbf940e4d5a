#include "loading/edits/changes.h"
#include "scene/edits.h"

namespace palpa {

void ReleaseEdit::apply(World& world, std::size_t slot) const {
    const Entity hand = find_hand(world, slot);
    edit_whole(world, [&](World& changed) { release(changed, hand); });
}

}  // namespace palpa
