// The two sides of a joined part, as the passes over an assembly tree see them.
#pragma once
#include "assembly/passes.h"

#include <array>
#include <cstdint>

namespace palpa {

// Where a side's quantities stand in the arrays of a state; the handle that is joined is its last.
struct Side {
    const AssemblyNode* node;
    double sign;  // of the acceleration of the joined handle in u = a_A - a_B

    std::uint32_t joined() const noexcept { return node->handles - 1; }
    std::uint32_t handle(std::uint32_t i) const noexcept { return node->first_handle + i; }
    std::uint32_t joined_handle() const noexcept { return handle(joined()); }
    // i <= j
    std::uint32_t pair(std::uint32_t i, std::uint32_t j) const noexcept {
        return node->first_pair + pair_number(i, j);
    }
};

inline std::array<Side, 2> sides_of(const AssemblyTree& tree, const AssemblyNode& node) noexcept {
    return {Side{&tree.nodes[node.a], 1}, Side{&tree.nodes[node.b], -1}};
}

}  // namespace palpa
