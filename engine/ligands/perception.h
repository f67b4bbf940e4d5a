// Perceives the features of a molecule that matter for types: rings, aromaticity, and charges and
// orders that resonance distributes.
#pragma once
#include "ligands/graph.h"

#include <array>
#include <cstdint>
#include <vector>

namespace palpa {

enum class BondKind : std::uint8_t {
    Single,
    Double,
    Triple,
    Aromatic,   // in a ring with 4n + 2 pi electrons
    Resonance,  // to the ends of carboxylates, phosphates, nitro groups; of amidinium and
                // guanidinium
};

// The smallest rings: a shortest one through each pair of neighbouring bonds, of at most
// `largest_ring` atoms.
inline constexpr std::size_t largest_ring = 7;
std::vector<std::vector<std::uint32_t>> find_rings(const MoleculeGraph& graph);

struct Perceived {
    BondLists bonds;                                // of each atom
    std::vector<BondKind> kinds;                    // of each bond
    std::vector<std::vector<std::uint32_t>> rings;  // atoms of each ring in order
    std::vector<bool> ring_is_aromatic;
    std::vector<std::array<bool, largest_ring + 1>> in_ring_of;  // ring sizes of each atom
    std::vector<bool> is_aromatic;                               // of each atom
    std::vector<bool> bond_in_ring;                              // of each bond
    std::vector<double> charge;  // of each atom, e; formal, equal among what resonance makes equal
};

// All hydrogens must be there.
Perceived perceive(const MoleculeGraph& graph);

}  // namespace palpa
