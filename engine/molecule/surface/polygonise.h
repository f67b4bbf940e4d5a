// Marching cubes: triangles from samples at the points of a block.
#pragma once
#include "molecule/surface/lattice.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// A sign change between a point of the block and the next one along an axis.
struct LatticeCrossing {
    std::array<int, 3> point{};  // within the block
    int axis = 0;
    float share = 0;  // position on the edge to the next point, inside (0, 1)
};

struct LatticeSurface {
    std::vector<LatticeCrossing> vertices;  // each once
    std::vector<std::uint32_t> indices;     // three to a triangle, counter-clockwise from outside
};

// Above 0 is inside. Where corners of a cell's face are inside and outside by turns, those inside
// are held apart, in both cells alike: blocks that share a face's numbers share the surface's edges
// on it, and all blocks together give closed surfaces in which every edge belongs to two triangles.
// `surface` is overwritten.
void polygonise(const BlockSamples& samples, LatticeSurface& surface);

// The triangles of a cell, three edges each. Bit c of `inside` is corner c, at (c & 1, c >> 1 & 1,
// c >> 2); edge 4 a + n is the n-th along axis a, by the number of its lower corner.
std::span<const std::array<std::uint8_t, 3>> cell_triangles(unsigned inside);

}  // namespace palpa
