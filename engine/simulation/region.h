// Where only what is around the hands moves (joints.region_angstrom): which atoms may, and which
// the mechanics have.
#pragma once
#include "ecs/world.h"
#include "simulation/components.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// What hands held last: the region lies around it, also when they let go.
struct RegionCentre {
    std::vector<AtomsOf> parts;
    bool stays = false;  // another could not be had
};

struct Region {
    // Of each atom of the table, whether it may move: in residues of flexible molecules with an
    // atom in reach, and in molecules that are no more fixed than that, as wholes.
    std::vector<std::uint8_t> is_inside;
    // Of the mechanics, by the table's numbers, rising: these, the fixed ones from which they feel
    // anything, and what restraints pull at. Without any where nothing may move.
    std::vector<std::uint32_t> atoms;
};

// Fixed atoms are in it up to so far (Å) beyond the cutoff: mobile ones may go as far before they
// would feel others.
inline constexpr double region_margin = 6;

// From where everything is now; none where the scene says nothing of a region.
std::optional<Region> find_region(World& world);

}  // namespace palpa
