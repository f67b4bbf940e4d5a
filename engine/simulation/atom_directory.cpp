#include "simulation/atom_directory.h"

#include "simulation/grip_queries.h"

#include "simulation/components.h"
#include "simulation/resources.h"

#include <algorithm>
#include <cstddef>

namespace palpa {

void number_residues(AtomDirectory& directory) {
    std::vector<bool> begins(directory.names.size(), false);  // a molecule
    for (const AtomDirectory::Entry& entry : directory.molecules)
        if (entry.atoms.count > 0) begins[entry.atoms.first] = true;
    directory.residue_of.assign(directory.names.size(), 0);
    for (std::size_t i = 1; i < directory.names.size(); ++i) {
        const bool goes_on =
            !begins[i] && is_same_residue(directory.names[i - 1], directory.names[i]);
        directory.residue_of[i] = directory.residue_of[i - 1] + (goes_on ? 0 : 1);
    }
}

std::shared_ptr<const AtomDirectory> list_atoms(const World& world) {
    auto directory = std::make_shared<AtomDirectory>();
    directory->names = world.resource<AtomTable>().names;
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        directory->molecules.push_back({molecule.name, molecule.atoms, molecule.reference_atom});
    });
    number_residues(*directory);
    directory->force_field = world.resource<ForceFieldInUse>().force_field;
    return directory;
}

const AtomDirectory::Entry* find_molecule(const AtomDirectory& directory, std::string_view name) {
    const auto found =
        std::ranges::find(directory.molecules, name, &AtomDirectory::Entry::molecule);
    return found == directory.molecules.end() ? nullptr : &*found;
}

std::string address_of(const AtomDirectory& directory, std::uint32_t atom, AtomScope scope) {
    const auto found = std::ranges::find_if(
        directory.molecules,
        [&](const AtomDirectory::Entry& entry) { return has_atom(entry.atoms, atom); });
    if (found == directory.molecules.end()) return {};
    const AtomName& name = directory.names[atom];
    switch (scope) {
        case AtomScope::Molecule:
            break;
        case AtomScope::Residue:
            return found->molecule + ":" + name.number;
        case AtomScope::Atom:
            return found->molecule + ":" + name.number + " " + name.atom;
    }
    return found->molecule;
}

std::string held_address(const World& world, Entity hand, const AtomDirectory& atoms) {
    if (!world.find<Grip>(hand)) return {};
    const std::uint32_t first = held_range(world, hand).first;
    if (holds_whole(world, hand)) return address_of(atoms, first, AtomScope::Molecule);
    const std::vector<std::uint32_t> held = held_part_of(world, hand).atoms;
    return address_of(atoms, first + held.front(),
                      held.size() == 1 ? AtomScope::Atom : AtomScope::Residue);
}

}  // namespace palpa
