// Hydrogen-bond sites of amides and histidine rings, as they are and flipped.
#pragma once
#include "molecule/atoms.h"
#include "prepare/hydrogen_bonds.h"
#include "prepare/residues.h"

#include <array>
#include <string_view>
#include <vector>

namespace palpa {

// The rotation axis and the atoms that turn, for ASN, GLN, or a histidine.
struct TurnedAtoms {
    std::array<std::string_view, 2> axis;
    std::vector<std::string_view> atoms;
};
TurnedAtoms turned_atoms_of(std::string_view residue);

// The sites of an amide (`histidine` empty), or of a histidine's ring in that state ("HSD", "HSE",
// "HSP"). All atoms of turned_atoms_of but the first of the axis must be there; for a flip that
// too.
std::vector<HydrogenSite> find_turned_sites(const Structure& structure, const ResidueRange& residue,
                                            bool is_flipped, std::string_view histidine);

// Flips the end of an amide, or the ring of a histidine, by half a turn about its bond, with its
// hydrogens.
void flip(Structure& structure, const ResidueRange& residue);

}  // namespace palpa
