#include "ligands/graph.h"

namespace palpa {

BondLists bonds_of_atoms(const MoleculeGraph& graph) {
    BondLists lists(graph.size());
    for (std::uint32_t i = 0; i < graph.bonds.size(); ++i) {
        lists[graph.bonds[i].a].push_back(i);
        lists[graph.bonds[i].b].push_back(i);
    }
    return lists;
}

int total_charge(const MoleculeGraph& graph) {
    int charge = 0;
    for (const GraphAtom& atom : graph.atoms) charge += atom.charge;
    return charge;
}

MoleculeGraph without_atoms(const MoleculeGraph& graph, const std::vector<bool>& left_out) {
    MoleculeGraph kept;
    kept.name = graph.name;
    std::vector<std::uint32_t> index(graph.size());
    for (std::size_t i = 0; i < graph.size(); ++i) {
        index[i] = static_cast<std::uint32_t>(kept.size());
        if (!left_out[i]) kept.atoms.push_back(graph.atoms[i]);
    }
    for (const GraphBond& bond : graph.bonds) {
        if (left_out[bond.a] || left_out[bond.b]) continue;
        kept.bonds.push_back({index[bond.a], index[bond.b], bond.order});
    }
    return kept;
}

}  // namespace palpa
