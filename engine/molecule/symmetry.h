// Finds symmetric atoms of a molecule, such as the two sides of a phenyl ring.
#pragma once
#include "math/rigid_motion.h"
#include "molecule/atoms.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// The heavy atoms (all but hydrogens) of a group, and in which ways they may be numbered anew.
struct SymmetricAtoms {
    std::vector<std::uint32_t> atoms;  // numbers in the table
    // What stands in the place of each of `atoms`, as an index into them. The first leaves all.
    std::vector<std::vector<std::uint32_t>> symmetries;
};

// Ways to number anew that keep elements, hydrogens, bonds and chirality; at most `most`, those
// beyond are left out. Chirality is that of the table's positions: where three neighbours are not
// in a plane with their atom, their sense of rotation stays.
SymmetricAtoms find_symmetries(const AtomTable& table, std::span<const std::uint32_t> group,
                               std::size_t most = 10'000);

// The least sum over ways to number anew of squared distances, Å^2, between motion * from and to;
// positions of all atoms of the table.
double find_square_distance(const SymmetricAtoms& group, const RigidMotion& motion,
                            std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace palpa
