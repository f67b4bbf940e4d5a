// Finds hydrogen bonds from the positions of atoms.
#pragma once
#include "ecs/world.h"
#include "scene/choices.h"

#include <cstdint>
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

}  // namespace palpa
