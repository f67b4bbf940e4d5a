#include "loading/edits/changes.h"
#include "scene/edits.h"
#include "simulation/resources.h"

#include <algorithm>

namespace palpa {

void RenameEdit::apply(World& world, std::size_t /*hand*/) const {
    const Entity renamed = find_molecule(world, molecule);
    if (to == molecule) return;
    check_name_is_new(world, to);
    world.write<Molecule>(renamed)->name = to;
    const auto follow = [&](std::string& name) {
        if (name == molecule) name = to;
    };
    std::ranges::for_each(world.write<ForceFieldInUse>().structural_waters, follow);
    follow(world.write<MechanicsSettings>().joints.around);
    world.write_each<GripSettings>(
        [&](Entity, GripSettings& settings) { follow(settings.measured_from); });
}

}  // namespace palpa
