// What the atoms of a world are called, as edits name them: for those who see pictures of it and
// not the world.
#pragma once
#include "charmm/force_field.h"
#include "ecs/world.h"
#include "molecule/atoms.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct AtomDirectory {
    struct Entry {
        std::string molecule;
        AtomRange atoms;
        std::uint32_t reference_atom;
    };
    std::vector<Entry> molecules;
    std::vector<AtomName> names;                    // of the atoms of the table
    std::vector<std::uint32_t> residue_of;          // of each atom, rising from 0: number_residues
    std::shared_ptr<const ForceField> force_field;  // of what can be added; it never changes
};

// Null where there is none of that name.
const AtomDirectory::Entry* find_molecule(const AtomDirectory& directory, std::string_view name);

// Fills `residue_of` from molecules and names.
void number_residues(AtomDirectory& directory);

// As long as nothing is added or removed.
std::shared_ptr<const AtomDirectory> list_atoms(const World& world);

// What of it an edit is about.
enum class AtomScope { Molecule, Residue, Atom };

// Its molecule, residue or itself as scene/edits.h writes it: "protease_a:25 CA". Empty where there
// is no such atom.
std::string address_of(const AtomDirectory& directory, std::uint32_t atom, AtomScope scope);

// What the hand holds, as an edit takes it: a molecule, or at a spring an atom or a residue; empty:
// nothing.
std::string held_address(const World& world, Entity hand, const AtomDirectory& directory);

}  // namespace palpa
