// Which pairs of a set of atoms act on each other, clusters of eight atoms beside clusters: what
// the single-precision kernel (field/pair_kernel.h) sums over. After S. Páll, B. Hess, Comput.
// Phys. Commun. 184, 2641 (2013).
#pragma once
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpa {

inline constexpr std::size_t cluster_size = 8;

// Fills the places of the last cluster that no atom has.
inline constexpr std::uint32_t no_atom = std::numeric_limits<std::uint32_t>::max();

// A cluster beside the one whose tile this is, all eight columns: bit r of `rows` is set where row
// r, an atom of the first cluster, may be near one of them.
struct ClusterTile {
    std::uint32_t cluster = 0;
    std::uint32_t rows = 0;
};

// The same where some pairs are left out: bit 8 r + c is that of row r and column c.
struct MaskedTile {
    std::uint32_t cluster = 0;
    std::uint64_t pairs = 0;
};

// Every pair of atoms stands in one tile at most. The order is that of places and indices alone, so
// it repeats.
struct ClusterList {
    double cutoff = std::numeric_limits<double>::infinity();  // Å; infinite for all pairs
    double skin = 0;                                          // Å
    std::vector<Vec3> positions;  // when the list was built; none for all pairs
    // Atoms, eight a cluster, then eight times `no_atom`: the empty cluster.
    std::vector<std::uint32_t> atoms;
    // Tiles of cluster c: [first[c], first[c + 1]), an even number, filled up with the empty
    // cluster's.
    std::vector<std::size_t> first_plain, first_masked;
    std::vector<ClusterTile> plain;
    std::vector<MaskedTile> masked;

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

// The pairs of all tiles, one by one.
std::vector<std::array<std::uint32_t, 2>> list_pairs(const ClusterList& list);

// Whether a pair that is not in the list may have come nearer than the cutoff: an atom has moved
// more than half the skin, or is nowhere. Never for all pairs.
bool is_outdated(const ClusterList& list, std::span<const Vec3> positions) noexcept;

}  // namespace palpa
