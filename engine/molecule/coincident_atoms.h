// Atoms in one place, where no chemistry puts them.
#pragma once
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace palpa {

// Atoms closer than `distance`, Å: each with the first atom before it that it coincides with and
// that itself coincides with none before it. In time proportional to the number of atoms, however
// many are in one place.
std::vector<std::array<std::size_t, 2>> find_coincident_atoms(std::span<const Vec3> positions,
                                                              double distance);

}  // namespace palpa
