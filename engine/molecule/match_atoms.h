// Finds the atoms of one file in another, by name and never by order.
#pragma once
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <vector>

namespace palpa {

// The position of every atom of `connectivity` in `structure`, Å, in the connectivity's order.
// Atoms are the same if segment, residue, number and name are; where the two files call segments by
// other names (a segment here, a chain there), if the other three are and belong to one atom only.
// Atoms of the structure that the connectivity does not have are left alone. Throws LoadError that
// lists all atoms without a place.
std::vector<Vec3> match_positions(const Connectivity& connectivity, const Structure& structure);

}  // namespace palpa
