// Finds the bridges of a molecule's bond graph: bonds without which it falls into two parts.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

struct Neighbour {
    std::uint32_t atom;
    std::uint32_t bond;  // index of the bond
};

// The bonded neighbours of each atom, in the order of the bonds.
class Neighbours {
public:
    // Leaves out the bonds marked in `is_cut` (empty, or one entry per bond).
    Neighbours(std::size_t atoms, std::span<const std::array<std::uint32_t, 2>> bonds,
               std::span<const std::uint8_t> is_cut = {});

    std::span<const Neighbour> of(std::uint32_t atom) const noexcept {
        return std::span(entries_).subspan(first_[atom], first_[atom + 1] - first_[atom]);
    }
    std::size_t atoms() const noexcept { return first_.size() - 1; }

private:
    std::vector<std::uint32_t> first_;
    std::vector<Neighbour> entries_;
};

// One entry per bond: 1 for a bridge, 0 otherwise and for cut bonds. (R. Tarjan 1974)
std::vector<std::uint8_t> find_bridges(const Neighbours& neighbours, std::size_t bonds);

}  // namespace palpa
