// The neighbour list: pairs of clusters of eight atoms, over which the single-precision kernel
// (field/pair_kernel.h) sums. After S. Páll, B. Hess, Comput. Phys. Commun. 184, 2641 (2013).
#pragma once
#include "field/cluster_tree.h"
#include "field/near_rows.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpa {

// Fills the empty places of the last cluster.
inline constexpr std::uint32_t no_atom = std::numeric_limits<std::uint32_t>::max();

// A cluster beside the one whose tile this is, all eight columns: bit r of `rows` is set where row
// r, an atom of the first cluster, may be near one of them.
struct ClusterTile {
    std::uint32_t cluster = 0;
    std::uint32_t rows = 0;
};

// The same with some pairs left out: bit 8 r + c stands for row r and column c.
struct MaskedTile {
    std::uint32_t cluster = 0;
    std::uint64_t pairs = 0;
};

// The pairs that a tile leaves out.
struct TileGap {
    std::uint32_t row_cluster = 0, cluster = 0;
    std::uint64_t pairs = 0;
};

// State of the list for `update_cluster_list`.
struct ClusterListMemory {
    std::vector<std::uint32_t> place_of;  // in `ClusterList::atoms`, of each atom
    std::vector<TileGap> gaps;            // of cluster c: [first_gap[c], first_gap[c + 1]), sorted
    std::vector<std::size_t> first_gap;
    ClusterTree tree;                         // by `ClusterList::positions`
    std::size_t rows = 0, rows_at_build = 0;  // rows of all plain tiles, the work of the kernel

    struct FoundTile {
        std::uint32_t row_cluster, cluster, rows;
    };
    std::vector<std::uint8_t> is_moved, is_touched;  // per cluster; zero between two calls
    std::vector<std::uint32_t> moved, touched;       // clusters
    std::vector<FoundTile> found, sorted;
    std::vector<std::size_t> slots;  // per cluster
};

// Every pair of atoms stands in one tile at most. The order is that of places and indices alone, so
// it repeats.
struct ClusterList {
    double cutoff = std::numeric_limits<double>::infinity();  // Å; infinite for all pairs
    double skin = 0;                                          // Å
    // Of each atom when the tiles of its cluster were found last; none for all pairs.
    std::vector<Vec3> positions;
    // Atoms, eight a cluster, then eight times `no_atom`: the empty cluster.
    std::vector<std::uint32_t> atoms;
    // Tiles of cluster c: [first[c], first[c + 1]), an even number, filled up with the empty
    // cluster's, which are without rows or pairs.
    std::vector<std::size_t> first_plain, first_masked;
    std::vector<ClusterTile> plain;
    std::vector<MaskedTile> masked;
    ClusterListMemory memory;

    std::size_t clusters() const noexcept { return atoms.size() / cluster_size - 1; }
};

// All pairs, whatever the positions, but for those left out (each given once, either way round).
// `groups` is empty or has a number for each atom: tiles whose atoms all have one number are left
// out too, for those who do not ask what atoms of one rigid body do to each other; such atoms stand
// beside each other, then.
ClusterList build_full_cluster_list(std::size_t atom_count,
                                    std::span<const std::array<std::uint32_t, 2>> left_out,
                                    std::span<const std::uint32_t> groups = {});

// The pairs nearer than cutoff + skin, and some more, but for those left out. Clusters are what is
// left of halving the atoms again and again across their longest extent. The memory of `storage`,
// an earlier list, is used again.
ClusterList build_cluster_list(std::span<const Vec3> positions,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               double cutoff, double skin, ClusterList storage = {});

enum class ListChange {
    None,
    Tiles,    // the tiles were updated; clusters are the same
    Clusters  // the list was rebuilt
};

// Where an atom has moved more than half the skin since its place in the list was taken, finds the
// tiles of all clusters anew that have an atom moved more than a quarter of it; so a list is right
// that is not outdated then. Takes time by what moved. Builds anew, as `build_cluster_list` with
// the same atoms, what is not worth it: where more than half of the clusters moved, or clusters
// have become so wide that the tiles have a quarter more rows than after the last build.
ListChange update_cluster_list(std::span<const Vec3> positions,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               ClusterList& list);

// The same where only the atoms named, each once or more, have moved since the last call; what
// others are at is not looked at unless the list is built anew.
ListChange update_cluster_list(std::span<const Vec3> positions,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               std::span<const std::uint32_t> moved, ClusterList& list);

// The pairs of all tiles as a list.
std::vector<std::array<std::uint32_t, 2>> list_pairs(const ClusterList& list);

// Whether a pair that is not in the list may have come nearer than the cutoff: an atom has moved
// more than half the skin, or is nowhere. Never for all pairs.
bool is_outdated(const ClusterList& list, std::span<const Vec3> positions) noexcept;

}  // namespace palpa
