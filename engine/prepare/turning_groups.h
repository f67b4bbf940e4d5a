// Finds groups of atoms that turn together: rotors and waters, by their bonds.
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

// A group that turns as one body.
struct TurningGroup {
    OrientedGroup::Kind kind;
    std::uint32_t centre;               // fixed centre
    std::optional<std::uint32_t> axis;  // other atom of the axis; unset: any rotation
    std::vector<std::uint32_t> moved;
    double period = 2 * std::numbers::pi;  // period of its symmetry, rad
    double reach = 0;                      // largest distance of the moved atoms from the centre, Å
    std::vector<std::uint32_t> dihedrals, impropers;  // terms that change as it turns
};

// By kind, then by atom; only those all of whose hydrogens are in `built`. Terms are left empty.
std::vector<TurningGroup> find_turning_groups(const BondGraph& graph,
                                              std::span<const std::uint32_t> built,
                                              std::size_t atoms, const OrientSettings& settings);

}  // namespace palpa
