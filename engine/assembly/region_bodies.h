// Builds bodies for molecules of which only a region moves; everything outside is fixed.
#pragma once
#include "assembly/bodies.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// The bonds to be cut where chains leave a region, so that what turns inside moves nothing outside.
// Of each piece inside, that is what is bonded there but for `springs`, the bond that leads out to
// the lowest atom stays, in a protein that to the residue before: on it the piece hangs.
// `is_inside` has one entry per atom. Lower atom first, in the order of the bonds.
std::vector<std::array<std::uint32_t, 2>> find_region_cuts(
    const Connectivity& connectivity, std::span<const std::uint8_t> is_inside,
    std::span<const std::array<std::uint32_t, 2>> springs);

struct CutBodies {
    TorsionBodies bodies;
    std::vector<std::uint32_t> molecules;  // index of each molecule in the whole, ascending
};

// Those atoms of bodies, rising, by their new numbers. Bodies without any are left out: only bases
// on which nothing hangs may be. Both atoms of each axis must stay; of springs those do that have
// both atoms.
CutBodies cut_bodies(const TorsionBodies& whole, std::span<const std::uint32_t> atoms);

}  // namespace palpa
