// Finds hydrogen bonds from the positions of atoms.
#pragma once
#include "ecs/world.h"
#include "molecule/atoms.h"
#include "scene/choices.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace palpa {

struct HydrogenBond {
    std::uint32_t hydrogen = 0, acceptor = 0;  // atoms of the table
    double length = 0;                         // Å, hydrogen to acceptor
    std::uint32_t donor = 0;                   // the atom bonded to the hydrogen
};

// D-H...A, where D and A are nitrogen, oxygen or sulphur, A not a nitrogen with four bonds; shorter
// than 2.5 Å, and the angle at H above 120°: E. N. Baker, R. E. Hubbard, Prog. Biophys. Mol. Biol.
// 44, 97 (1984). The shortest first.
std::vector<HydrogenBond> find_hydrogen_bonds(const World& world,
                                              ShownBonds which = ShownBonds::InHand);

// What some atoms can bond with, in the order of the table. It stays while their bonds stay.
struct BondSites {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> hydrogens;  // each with its donor
    std::vector<std::uint32_t> acceptors;
};
// Of `chosen` donors and acceptors; their hydrogens need not be chosen.
BondSites find_bond_sites(const AtomTable& atoms, const std::vector<bool>& chosen);
// Bonds from a donor of one to an acceptor of the other, in either direction, each once. Looks at
// these atoms alone.
std::size_t count_hydrogen_bonds(const AtomTable& atoms, const BondSites& one,
                                 const BondSites& other);

}  // namespace palpa
