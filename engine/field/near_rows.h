// Finds which atoms of a cluster are near which atoms of another, the most frequent question of a
// neighbour list. Compiled for each instruction set, with the same result on all.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace palpa {

inline constexpr std::size_t cluster_size = 8;

// Coordinates of a cluster's atoms, Å; NaN for empty places, which are near nothing.
struct alignas(64) ClusterPlaces {
    std::array<double, cluster_size> x, y, z;
};

// Bit r is set where row r of `a` is nearer than the root of `reach2` (Å^2) to an atom of `b`.
std::uint32_t find_near_rows(const ClusterPlaces& a, const ClusterPlaces& b,
                             double reach2) noexcept;

// The same for single pairs: bit 8 r + c stands for row r and atom c of `b`.
std::uint64_t find_near_pairs(const ClusterPlaces& a, const ClusterPlaces& b,
                              double reach2) noexcept;

}  // namespace palpa
