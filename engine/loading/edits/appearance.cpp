#include "loading/edits/changes.h"
#include "scene/description.h"
#include "scene/edits.h"

namespace palpa {

void AppearanceEdit::apply(World& world, std::size_t /*hand*/) const {
    const Entity found = find_molecule(world, molecule);
    Appearance appearance;
    if (const Appearance* const before = world.find<Appearance>(found)) appearance = *before;
    if (representation) appearance.representation = representation;
    if (colouring) appearance.colouring = colouring;
    if (visible) appearance.visible = *visible;
    world.set(found, appearance);
}

}  // namespace palpa
