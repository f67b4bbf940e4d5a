// Cuts a sphere of whole residues out of a larger system, to make similar systems of any size.
#pragma once
#include "charmm/topology.h"
#include "math/vec.h"
#include "molecule/connectivity.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

struct CutSystem {
    std::vector<std::uint32_t> atoms;  // index of each atom in the whole, ascending
    Connectivity connectivity;
    Topology topology;
    std::vector<Vec3> positions;  // Å
};

// The residues with the atom nearest to `centre`, as many of them as have no more than `most_atoms`
// atoms together, that of `centre` in any case. `centre` and the result are indices of atoms, the
// result rises. A residue is atoms of one in a row; of two equally near ones the first counts.
std::vector<std::uint32_t> find_sphere(const Connectivity& connectivity,
                                       std::span<const Vec3> positions, std::uint32_t centre,
                                       std::size_t most_atoms);

// Cuts a sphere; separate pieces of chain become molecules of their own.
CutSystem cut_sphere(const Connectivity& connectivity, const Topology& topology,
                     std::span<const Vec3> positions, std::uint32_t centre, std::size_t most_atoms);

}  // namespace palpa
