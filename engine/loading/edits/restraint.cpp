#include "loading/edits/changes.h"
#include "scene/edits.h"
#include "simulation/mechanics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace palpa {

void RestraintEdit::apply(World& world, std::size_t /*hand*/) const {
    const auto change = [&](World& changed) {
        const Spring spring = build_spring(changed, *this);
        Entity same;
        changed.each<Spring>([&](Entity entity, const Spring& other) {
            if (other.owner == Entity{} && other.ends == spring.ends) same = entity;
        });
        if (spring.k == 0) {
            if (same == Entity{})
                refuse(fmt::format("there is no spring at {} to remove; expected k above 0",
                                   fmt::join(atoms, " and ")));
            return changed.destroy(same);
        }
        changed.set(same == Entity{} ? changed.create() : same, spring);
        if (!needs_mechanics(changed))
            refuse(
                "a restraint has no effect, because no molecule moves by itself; expected a "
                "molecule with motion = \"free\" or shape = \"flexible\"");
    };
    edit_whole(world, change);
}

}  // namespace palpa
