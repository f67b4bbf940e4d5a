// Finds the atoms of one file in another, by name and never by order.
#pragma once
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <vector>

namespace palpa {

// The position of every atom of `connectivity` in `structure`, Å, in the connectivity's order.
// Atoms are the same if segment, residue, number and name are. Where the two files call a segment
// by other names, it is the one segment or chain of the structure that has all of its residues and
// atoms and is no other segment's; of several alike, the one chain whose name the segment's ends
// with ("PROA" is what CHARMM-GUI calls the protein's chain A). Where a segment is spread over
// several of the structure, its atoms are found by residue, number and name if these are no other
// atom's.
//
// Atoms of the structure that the connectivity does not have are left alone. Throws LoadError at
// the first atom without a place: how many there are, which segments the files have and fit each
// other, which residues are called or numbered otherwise.
std::vector<Vec3> match_positions(const Connectivity& connectivity, const Structure& structure);

}  // namespace palpa
