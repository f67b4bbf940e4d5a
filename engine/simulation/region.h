// The region in which atoms move (joints.region_angstrom): the atoms that may move, and those that
// the mechanics contain.
#pragma once
#include "ecs/world.h"
#include "simulation/components.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// What hands held last; the region stays around it after they release it.
struct RegionCentre {
    std::vector<AtomsOf> parts;
    bool stays = false;  // no other region could be built
};

struct Region {
    // For each atom of the table, whether it may move: residues of flexible molecules with an atom
    // in reach, and molecules that are not fixed, as wholes.
    std::vector<std::uint8_t> is_inside;
    // Atoms of the mechanics by table index, ascending: the atoms inside, the fixed ones that act
    // on them, and those that restraints pull. Empty if nothing may move.
    std::vector<std::uint32_t> atoms;
};

// Fixed atoms are included up to this distance (Å) beyond the cutoff: mobile atoms may move as far
// before the mechanics are rebuilt.
inline constexpr double region_margin = 6;

// The region at the present positions; nothing if the scene has none.
std::optional<Region> find_region(World& world);

}  // namespace palpa
