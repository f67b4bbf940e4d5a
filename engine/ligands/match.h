// Matches the atoms of two descriptions of a molecule.
#pragma once
#include "ligands/graph.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// For each heavy atom of `found` (in its order, hydrogens left out) the atom of `known`; `found`
// may lack some. By names, if all of them are there with the same elements; else by elements and
// bonds, whatever their order, the first way there is. None: `found` is no part of `known`.
std::optional<std::vector<std::uint32_t>> match_atoms(const MoleculeGraph& known,
                                                      const MoleculeGraph& found);

}  // namespace palpa
