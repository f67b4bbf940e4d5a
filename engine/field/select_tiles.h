// Selects from a cluster list the tiles that are near now, only between different rigid bodies,
// whose own pairs keep their distances.
#pragma once
#include "field/cluster_list.h"
#include "math/vec.h"

#include <cstdint>
#include <span>

namespace palpa {

// A list with every pair of `list` that is nearer than its cutoff and `skin` (Å, at most that of
// `list`) and whose atoms have different groups; and some others, always the same for the same
// arguments. `groups` is empty or has a number for each atom. The list has the clusters alone that
// stand in one of its tiles, and no places: whether it is outdated is the caller's to know. Of two
// clusters the one with fewer rows that need it has the rows.
ClusterList select_tiles(const ClusterList& list, std::span<const std::uint32_t> groups,
                         std::span<const Vec3> positions, double skin);

}  // namespace palpa
