// Which atoms may turn together: rotors and waters, found by their bonds.
#pragma once
#include "prepare/bond_graph.h"
#include "prepare/orient.h"

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// What turns as one body.
struct TurningGroup {
    OrientedGroup::Kind kind;
    std::uint32_t centre;               // stays where it is
    std::optional<std::uint32_t> axis;  // the other atom of the axis; none: any rotation
    std::vector<std::uint32_t> moved;
    double period = 2 * std::numbers::pi;  // rad, after how much of a turn it is the same
    double reach = 0;                      // Å, of the moved atoms from the centre
    std::vector<std::uint32_t> dihedrals, impropers;  // that change as it turns
};

// By kind, then by atom; only those all of whose hydrogens are in `built`. Terms are left empty.
std::vector<TurningGroup> find_turning_groups(const BondGraph& graph,
                                              std::span<const std::uint32_t> built,
                                              std::size_t atoms, const OrientSettings& settings);

}  // namespace palpa
