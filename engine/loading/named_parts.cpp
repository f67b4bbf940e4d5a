#include "loading/named_parts.h"

#include "simulation/grip_queries.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

namespace palpa {
namespace {

AtomsOf find_some_atoms(const World& world, const std::string& address) {
    AtomsOf found = find_atoms(world, address);
    if (found.atoms.empty())
        refuse(
            fmt::format("\"{}\" is a whole molecule; expected a residue or atom of it, such as "
                        "\"{}:25\" or \"{}:25 CA\"",
                        address, address, address));
    return found;
}

std::string address_of(const World& world, const AtomsOf& atoms) {
    return fmt::format("{}:{}", world.find<Molecule>(atoms.molecule)->name,
                       name_within(world, atoms));
}

}  // namespace

void refuse(const std::string& what) { throw LoadError({"edit"}, what); }

Entity find_molecule(const World& world, std::string_view name) {
    const Entity found = molecule_called(world, name);
    if (found != Entity{}) return found;
    std::vector<std::string> names;
    world.each<Molecule>([&](Entity, const Molecule& molecule) { names.push_back(molecule.name); });
    refuse(fmt::format("there is no molecule '{}'; there are {}", name, fmt::join(names, ", ")));
}

AtomsOf find_atoms(const World& world, const std::string& address) {
    const std::size_t colon = address.find(':');
    AtomsOf found{find_molecule(world, address.substr(0, colon)), {}};
    if (colon == std::string::npos) return found;
    const std::string name = address.substr(colon + 1);
    found.atoms = atoms_called(world, found.molecule, name);
    if (found.atoms.empty()) {
        refuse(
            fmt::format("'{}' has no residue or atom \"{}\"; expected a residue's number as "
                        "\"25\" or \"27A\", or an atom's as \"25 CA\"",
                        address.substr(0, colon), name));
    }
    return found;
}

Spring build_spring(const World& world, const RestraintEdit& restraint) {
    Spring spring;
    for (const std::string& address : restraint.atoms)
        spring.ends.push_back(find_some_atoms(world, address));
    const bool has_place = restraint.place_angstrom.has_value();
    if (spring.ends.size() != (has_place ? 1 : 2))
        refuse("a restraint is between two atoms or residues, or from one to a place");
    if (has_place) spring.place = Vec3(restraint.place_angstrom->data());
    spring.k = restraint.k_kcal_per_mol_angstrom2;
    spring.length = restraint.length_angstrom;
    return spring;
}

Mark build_mark(const World& world, const PinEdit& pin) {
    Mark mark;
    for (const std::string& address : pin.atoms)
        mark.atoms.push_back(find_some_atoms(world, address));
    if (mark.atoms.empty() || mark.atoms.size() > 4)
        refuse(fmt::format("{} atoms are pinned; expected 1 to 4", mark.atoms.size()));
    return mark;
}

std::string name_within(const World& world, const AtomsOf& atoms) {
    const Molecule& molecule = *world.find<Molecule>(atoms.molecule);
    const std::uint32_t first = atoms.atoms.front();
    const AtomName& name = world.resource<AtomTable>().names[molecule.atoms.first + first];
    for (const std::string& called :
         {name.number + " " + name.atom, fmt::format("#{}", first + 1), name.number})
        if (atoms_called(world, atoms.molecule, called) == atoms.atoms) return called;
    refuse(
        fmt::format("{} atoms of '{}' are held together that are no residue; expected an atom "
                    "or a residue",
                    atoms.atoms.size(), molecule.name));
}

RestraintEdit describe(const World& world, const Spring& spring) {
    RestraintEdit restraint;
    for (const AtomsOf& end : spring.ends) restraint.atoms.push_back(address_of(world, end));
    if (spring.ends.size() == 1)
        restraint.place_angstrom = {spring.place.x(), spring.place.y(), spring.place.z()};
    restraint.k_kcal_per_mol_angstrom2 = spring.k;
    restraint.length_angstrom = spring.length;
    return restraint;
}

PinEdit describe(const World& world, const Mark& mark) {
    PinEdit pin;
    for (const AtomsOf& atoms : mark.atoms) pin.atoms.push_back(address_of(world, atoms));
    return pin;
}

}  // namespace palpa
