// Of a list of clusters, what lies between atoms of different groups: rigid bodies, whose own pairs
// keep their distances.
#pragma once
#include "field/cluster_list.h"

#include <cstdint>
#include <span>

namespace palpa {

// A list with every pair of `list` whose atoms have different groups, one number per atom, and some
// with equal ones, always the same for the same list and groups. It has the clusters alone that
// stand in one of its tiles, and no places: it is never outdated, `list` is. Of two clusters the
// one with fewer rows that need it has the rows.
ClusterList select_tiles_between_groups(const ClusterList& list,
                                        std::span<const std::uint32_t> groups);

}  // namespace palpa
