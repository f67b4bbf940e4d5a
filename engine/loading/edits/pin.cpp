#include "loading/edits/changes.h"
#include "scene/edits.h"

namespace palpa {

void PinEdit::apply(World& world, std::size_t /*hand*/) const {
    const Mark mark = build_mark(world, *this);
    Entity same;
    world.each<Mark>([&](Entity entity, const Mark& other) {
        if (other.atoms == mark.atoms) same = entity;
    });
    if (same != Entity{}) return world.destroy(same);
    world.set(world.create(), mark);
}

}  // namespace palpa
