// Names of the atoms of a world as edits use them, for code that sees pictures of the world but not
// the world.
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
    std::vector<AtomName> names;  // in the order of the atom table
    std::vector<std::uint32_t>
        residue_of;  // residue index of each atom, ascending from 0: see number_residues
    std::shared_ptr<const ForceField>
        force_field;  // of the residues that can be added; never changes
};

// Null if no molecule has that name.
const AtomDirectory::Entry* find_molecule(const AtomDirectory& directory, std::string_view name);

// Computes `residue_of` from molecules and names.
void number_residues(AtomDirectory& directory);

// Valid until atoms are added or removed.
std::shared_ptr<const AtomDirectory> list_atoms(const World& world);

// What an edit refers to.
enum class AtomScope { Molecule, Residue, Atom };

// Address of the atom's molecule, of its residue or of the atom, as in scene/edits.h:
// "protease_a:25 CA". Empty if there is no such atom.
std::string address_of(const AtomDirectory& directory, std::uint32_t atom, AtomScope scope);

// Address of what the hand holds, as in edits: a molecule, or with a spring an atom or a residue;
// empty if it holds nothing.
std::string held_address(const World& world, Entity hand, const AtomDirectory& directory);

}  // namespace palpa
