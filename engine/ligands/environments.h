// Describes the surroundings of an atom by keys that are equal for equal surroundings.
#pragma once
#include "ligands/graph.h"
#include "ligands/perception.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa {

// From coarse to specific.
enum class Surroundings : std::uint8_t {
    Element,
    Bonds,        // and the kinds of its bonds
    Kinds,        // and its hydrogens, and its neighbours' elements and pi bonds
    Atom,         // and its charge and ring sizes but for saturated rings of six
    Neighbours,   // and all its ring sizes, and its neighbours' bonds
    OneBondAway,  // and all of that of its neighbours
    TwoBondsAway,
    ThreeBondsAway
};
inline constexpr std::size_t surroundings_levels = 8;

// One of each level. Equal in any order of the atoms, and in each Kekulé form.

using EnvironmentKeys = std::array<std::uint64_t, surroundings_levels>;
std::vector<EnvironmentKeys> find_environments(const MoleculeGraph& graph, const Perceived& seen);

}  // namespace palpa
