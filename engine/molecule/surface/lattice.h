// Surfaces are found block by block of one cubic lattice, whose points stand at multiples of its
// spacing. What is computed at a lattice point depends on the point and on the atoms alone, so two
// blocks find the same, to the bit, on the face that they share.
#pragma once
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpa {

inline constexpr int block_cells = 8;                 // along an edge of a block
inline constexpr int block_points = block_cells + 1;  // both ends included
inline constexpr std::size_t points_of_block =
    std::size_t{block_points} * block_points * block_points;

// Block (i, j, k) begins at lattice point block_cells (i, j, k).
using BlockIndex = std::array<std::int32_t, 3>;

// One number for each point of a block, x fastest.
using BlockSamples = std::array<float, points_of_block>;

inline constexpr std::size_t point_index(int x, int y, int z) noexcept {
    return (static_cast<std::size_t>(z) * block_points + static_cast<std::size_t>(y)) *
               block_points +
           static_cast<std::size_t>(x);
}

// Where a block begins, Å.
inline Vec3 block_corner(const BlockIndex& block, double spacing) noexcept {
    return Vec3(block[0], block[1], block[2]) * (block_cells * spacing);
}

// Coordinate of a block's point along an axis, Å.
inline double point_coordinate(std::int32_t block, int point, double spacing) noexcept {
    return (static_cast<double>(block) * block_cells + point) * spacing;
}

}  // namespace palpa
