// Finds atoms that are too close to each other.
#pragma once
#include "math/vec.h"
#include "molecule/atoms.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Atoms closer than `distance`, Å: each with the first atom before it that it coincides with and
// that itself coincides with none before it. In time proportional to the number of atoms, however
// many are in one place.
std::vector<std::array<std::size_t, 2>> find_coincident_atoms(std::span<const Vec3> positions,
                                                              double distance);

// The closest pair and the number of other pairs as text for a warning. Unset if there are none.
std::optional<std::string> describe_coincident_atoms(std::span<const AtomName> names,
                                                     std::span<const Vec3> positions,
                                                     double distance);

}  // namespace palpa
