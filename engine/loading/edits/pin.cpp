#include "loading/edits/changes.h"
#include "scene/edits.h"

namespace palpa {

void PinEdit::apply(World& world, std::size_t /*hand*/) const {
    world.set(world.create(), build_mark(world, *this));
}

}  // namespace palpa
