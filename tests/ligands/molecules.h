// Small molecules written down for tests.
#pragma once
#include "ligands/graph.h"

#include <cstdint>
#include <string>
#include <vector>

namespace palpa::test {

// Heavy atoms by element, bonds by index with order; no hydrogens. Names are element and number
// from 1.
inline MoleculeGraph build_graph(const std::vector<std::string>& elements,
                                 const std::vector<GraphBond>& bonds) {
    MoleculeGraph graph;
    graph.name = "LIG";
    for (std::size_t i = 0; i < elements.size(); ++i) {
        graph.atoms.push_back({elements[i] + std::to_string(i + 1), elements[i], 0, std::nullopt});
    }
    graph.bonds = bonds;
    return graph;
}

// A ring of these elements with alternating orders from `first` on (2 1 2 1 ...).
inline MoleculeGraph build_ring(const std::vector<std::string>& elements,
                                const std::vector<int>& orders) {
    std::vector<GraphBond> bonds;
    const auto size = static_cast<std::uint32_t>(elements.size());
    for (std::uint32_t i = 0; i < size; ++i) bonds.push_back({i, (i + 1) % size, orders[i]});
    return build_graph(elements, bonds);
}

inline std::size_t count_element(const MoleculeGraph& graph, const std::string& element) {
    std::size_t count = 0;
    for (const GraphAtom& atom : graph.atoms) count += atom.element == element ? 1 : 0;
    return count;
}

}  // namespace palpa::test
