#include "loading/edits/changes.h"
#include "scene/edits.h"
#include "simulation/mechanics.h"

namespace palpa {

void RelaxEdit::apply(World& world, std::size_t /*hand*/) const {
    if (!needs_mechanics(world))
        refuse(
            "nothing here moves by itself; expected a molecule with motion = \"free\" or shape = "
            "\"flexible\"");
    edit_whole(world, [](World& changed) {
        if (relax_around_hands(changed).end == RelaxEnd::NotFinite)
            refuse("the energy is not finite; expected atoms that do not overlap");
    });
}

}  // namespace palpa
