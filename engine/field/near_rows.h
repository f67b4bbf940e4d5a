// Which atoms of a cluster are near which of another's: what lists of clusters ask most, by code
// that is compiled for each kind of processor, with the same answer on all.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace palpa {

inline constexpr std::size_t cluster_size = 8;

// A cluster's atoms by coordinate, Å; where there is none, NaN: nothing is near.
struct alignas(64) ClusterPlaces {
    std::array<double, cluster_size> x, y, z;
};

// Bit r is set where row r of `a` is nearer than the root of `reach2` (Å^2) to an atom of `b`.
std::uint32_t find_near_rows(const ClusterPlaces& a, const ClusterPlaces& b,
                             double reach2) noexcept;

// The same of single pairs: bit 8 r + c is that of row r and atom c of `b`.
std::uint64_t find_near_pairs(const ClusterPlaces& a, const ClusterPlaces& b,
                              double reach2) noexcept;

}  // namespace palpa
