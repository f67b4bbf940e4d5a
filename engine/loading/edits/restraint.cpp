#include "loading/edits/changes.h"
#include "scene/edits.h"
#include "simulation/mechanics.h"

namespace palpa {

void RestraintEdit::apply(World& world, std::size_t /*hand*/) const {
    edit_whole(world, [&](World& changed) {
        changed.set(changed.create(), build_spring(changed, *this));
        if (!needs_mechanics(changed))
            refuse(
                "a restraint has no effect, because no molecule moves by itself; expected a "
                "molecule with motion = \"free\" or shape = \"flexible\"");
    });
}

}  // namespace palpa
