// Matches the atoms of a residue to a template by elements and bonds, if names do not suffice.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "prepare/residues.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Heavy atoms and their bonds.
struct BondedAtoms {
    std::vector<std::string> names, elements;
    std::vector<std::vector<std::uint32_t>> neighbours;

    void add_bond(std::uint32_t a, std::uint32_t b);
};

// The heavy atoms of a residue, in the order of the file; bonded where they are closer than their
// covalent radii and 0.4 Å allow.
BondedAtoms find_bonded_atoms(const Structure& structure, const ResidueRange& residue);

// The heavy atoms of a residue of the force field.
BondedAtoms find_bonded_atoms(const ForceField& force_field, const Residue& residue);

// The element of an atom of the force field; what its name says where its type names none.
std::string element_of(const ForceField& force_field, const ResidueAtom& atom,
                       std::string_view name);

// For each atom of `given` one of `wanted`, each at most once: of the same element, bonded where
// `given` is bonded, and apart where it is apart. `wanted` may have more atoms. Of several ways,
// one that keeps names where it can; atoms that only their hydrogens or their handedness
// distinguish apart may be exchanged. Nothing where there is no way, or none within 200,000
// attempts.
std::optional<std::vector<std::uint32_t>> match_by_bonds(const BondedAtoms& given,
                                                         const BondedAtoms& wanted);

}  // namespace palpa
