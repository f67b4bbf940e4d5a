#include "charmm/force_field.h"
#include "loading/edits/changes.h"
#include "loading/molecules.h"
#include "loading/sources.h"
#include "scene/edits.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

Source build_source(const World& world, Entity original, const AddEdit& edit) {
    if (original != Entity{}) return copy_source(world, original, edit.name);
    if (!edit.structure.empty())
        return read_segment(edit.structure, edit.topology, edit.segment, edit.name);
    return build_residue(*world.resource<ForceFieldInUse>().force_field, edit.residue, edit.name);
}

void place_atoms(World& world, AtomRange range, const Vec3& by) {
    std::vector<Vec3>& positions = world.write<AtomTable>().positions;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) positions[i] += by;
}

}  // namespace

void AddEdit::apply(World& world, std::size_t /*hand*/) const {
    edit_whole(world, [&](World& changed) {
        check_name_is_new(changed, name);
        const ForceField& force_field = *changed.resource<ForceFieldInUse>().force_field;
        const bool is_copy = !copy_of.empty();
        const Entity original = is_copy ? find_molecule(changed, copy_of) : Entity{};
        Source source = build_source(changed, original, *this);
        AtomTable& atoms = changed.write<AtomTable>();
        const AtomRange range = add_segment_atoms(force_field, source, atoms);
        std::uint32_t reference = range.first;
        Mobility mobility{needs_mechanics(changed) ? Motion::Free : Motion::Fixed, Shape::Rigid};
        if (is_copy) {
            const Molecule& of = *changed.find<Molecule>(original);
            reference += of.reference_atom - of.atoms.first;
            mobility.shape = changed.find<Mobility>(original)->shape;
        }
        const Vec3 at(at_angstrom.data());
        place_atoms(changed, range, at - atoms.positions[reference]);
        check_room(atoms, range, name, "a place (at_angstrom)");
        set_start_places(changed, create_molecule(changed, {name, range, reference}, mobility,
                                                  std::move(source)));
        set_interactions(changed);
        changed.set_resource(BondedTerms{});
    });
}

}  // namespace palpa
