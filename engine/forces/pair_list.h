// The Verlet neighbour list: pairs of atoms that are near enough to interact, found once for many
// steps (L. Verlet, Phys. Rev. 159, 98 (1967)).
#pragma once
#include "charmm/topology.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Each pair that was nearer than cutoff + skin when the list was built stands in one row, that of
// either atom. Atoms near each other have rows near each other. The order is that of places and
// indices alone, so it repeats.
struct PairList {
    double cutoff = 0;                 // Å
    double skin = 0;                   // Å
    std::vector<Vec3> positions;       // at the build of the list
    std::vector<std::uint32_t> atoms;  // i-atom of each row
    std::vector<std::size_t>
        first;  // start of each row in `neighbours`; one entry more than there are rows
    std::vector<std::uint32_t> neighbours;

    std::span<const std::uint32_t> neighbours_of(std::size_t row) const noexcept {
        return std::span(neighbours).subspan(first[row], first[row + 1] - first[row]);
    }
};

// Without the pairs that the topology excludes and without those of two fixed atoms (`is_fixed` is
// empty or has one entry per atom). Time and memory grow with the number of atoms and of pairs,
// however far apart the atoms are; an atom that is nowhere (not a number) has no neighbours. The
// memory of `storage`, an earlier list, is used again.
PairList build_pair_list(const Exclusions& exclusions, double cutoff, double skin,
                         std::span<const Vec3> positions,
                         std::span<const std::uint8_t> is_fixed = {}, PairList storage = {});

// Whether a pair outside of the list may be nearer than the cutoff: an atom has moved more than
// half the buffer.
bool is_outdated(const PairList& list, std::span<const Vec3> positions) noexcept;

// Rows [begin, end) of a list.
struct PairRows {
    std::size_t begin, end;
};

// The rows between the shares `from` and `to` (0 to 1) of all pairs.
PairRows find_rows(const PairList& list, double from, double to) noexcept;

}  // namespace palpa
