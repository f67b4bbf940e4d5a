// Accelerations of torsion bodies at rest, in two ways that know nothing of assembly trees, both in
// long double: the mass matrix of all joints at once, and a recursion from the ends of the
// branches.
#pragma once
#include "assembly/passes.h"
#include "tests/support/torsion_molecules.h"

#include <cstdint>
#include <vector>

namespace palpa::test {

// What AssemblyState means by these names.
struct Held {
    std::vector<std::uint8_t> is_active;  // of each body
    std::vector<GuidedBase> guides;       // of each molecule
};

struct TorsionAccelerations {
    std::vector<double> joints;  // of each body, 0 for bases
    std::vector<Vec6> bases;     // of each molecule, at its centre of mass
};

// Of mass, of each molecule.
std::vector<Vec3> centres_of(const TorsionCase& c);

// J^T M J qdd = J^T (f - M a_0), where a_0 are the accelerations that held bases give to atoms.
TorsionAccelerations dense_accelerations(const TorsionCase& c, const Held& held);

// Articulated bodies (R. Featherstone, Rigid Body Dynamics Algorithms, 2008, table 7.1), spatial
// vectors about the molecule's centre of mass: the work grows with the number of bodies.
TorsionAccelerations recursive_accelerations(const TorsionCase& c, const Held& held);

}  // namespace palpa::test
