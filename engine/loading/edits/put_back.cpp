#include "loading/edits/changes.h"
#include "scene/edits.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {

void PutBackEdit::apply(World& world, std::size_t slot) const {
    const Entity hand = find_hand(world, slot);
    edit_whole(world, [&](World& changed) {
        Grip* const grip = changed.write<Grip>(hand);
        if (!grip)
            refuse("the hand holds nothing that could go back; expected one that holds some");
        const Molecule& molecule = *changed.find<Molecule>(grip->molecule);
        if (other_holder(changed, hand, grip->molecule) != Entity{}) {
            refuse(fmt::format("another hand holds '{}' too; expected it to release it first",
                               molecule.name));
        }
        AtomTable& atoms = changed.write<AtomTable>();
        std::ranges::copy(*changed.find<StartPlaces>(grip->molecule)->atoms,
                          atoms.positions.begin() + molecule.atoms.first);
        check_room(atoms, molecule.atoms, molecule.name, "room where it was at the start");
        const Vec3 place = holds_whole(changed, hand)
                               ? atoms.positions[molecule.reference_atom]
                               : middle_of(changed, held_part_of(changed, hand));
        grip->pose = {place - grip->anchor, Quat::Identity()};
        if (changed.find<RigidShape>(grip->molecule)) set_shape(changed, grip->molecule);
        begin_new_grip(changed, hand);
    });
}

}  // namespace palpa
