// Builds positions of missing atoms from bond lengths, angles and IC tables.
#pragma once
#include "charmm/complete.h"
#include "charmm/topology.h"
#include "math/vec.h"
#include "molecule/connectivity.h"

#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// What determined the position of an atom.
enum class PlacedBy {
    Neighbours,  // the free direction at its neighbour; names by the IC table
    Table,       // a dihedral of the IC table
    Guess,       // no dihedral known: trans, or any direction if there is no trans
};

struct PlacedAtom {
    std::uint32_t atom;
    PlacedBy by;
};

struct BuiltPositions {
    std::vector<PlacedAtom> placed;  // in the order of building
    std::vector<std::uint32_t>
        unplaced;  // ascending: atoms without a bonded atom that has a position
};

// Places the atoms whose position is not finite, heavy ones first, and moves no other. Bond lengths
// are those of the parameters (to the neighbour that an atom is built on; in a ring to both, where
// that can be), and so are angles, as far as what is there allows:
//   X-H with three neighbours   along minus the sum of the unit vectors to them;
//   planar X-H, X=O             in the plane, what the angle of the others leaves shared out;
//   XH2 with two neighbours     symmetric, H-X-H as the parameters have it;
//   XH3, XH2, XH with one       by a dihedral of the IC table, read either way round, XH3 with
//                               threefold symmetry;
//   heavy atoms                 in the same way, the table saying on which side; one that would be
//                               within 3 Å of another takes the roomiest of three staggered
//                               places, where its bond turns freely;
//   X without neighbours        (water) in any orientation.
// An atom of three bonds is planar where its angles in the parameters sum up to 350 degree or more.
// A dihedral between two such atoms is flat where the table has it within 15 degree of that. The
// two hydrogens of an XH2 are distinguished by the table, as are mirror images everywhere; without
// a line that says so either may come out. Finite wherever the given atoms are.
BuiltPositions build_positions(const Connectivity& connectivity, const Topology& topology,
                               std::span<const AtomCoordinate> coordinates,
                               std::span<Vec3> positions);

}  // namespace palpa
