#include "loading/edits/changes.h"
#include "scene/edits.h"

namespace palpa {

void MobilityEdit::apply(World& world, std::size_t /*hand*/) const {
    if (motion && *motion != Motion::Fixed && *motion != Motion::Free)
        refuse(
            "this motion needs a hand that holds the molecule; expected motion = \"fixed\" or "
            "\"free\"");
    edit_whole(world, [&](World& changed) {
        const Entity found = find_molecule(changed, molecule);
        bool is_held = false;
        changed.write_each<Grip>([&](Entity, Grip& grip) {
            if (grip.molecule != found) return;
            is_held = true;
            if (motion) grip.before.motion = *motion;
            if (shape) grip.before.shape = *shape;
        });
        Mobility& mobility = *changed.write<Mobility>(found);
        if (motion && !is_held) mobility.motion = *motion;
        if (shape) mobility.shape = *shape;
    });
}

}  // namespace palpa
