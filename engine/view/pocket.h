// The residues of a world, and those near to what hands hold.
#pragma once
#include "ecs/world.h"
#include "molecule/atoms.h"

#include <cstddef>
#include <span>
#include <vector>

namespace palpa {

// Atoms from `first` to before `end`.
struct ResidueSpan {
    std::size_t first = 0, end = 0;
    std::size_t alpha = 0;  // its atom CA, or `end` if it has none
};

// The residues of all molecules in the order of the table.
std::vector<ResidueSpan> find_residues(const World& world);

// For each atom, whether its residue has an atom within 4.5 Å of what hands hold. False for held
// atoms.
std::vector<bool> find_pocket(const World& world, std::span<const ResidueSpan> residues);

}  // namespace palpa
