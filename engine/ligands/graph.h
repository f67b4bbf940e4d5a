// The chemistry of one small molecule: its atoms with elements and formal charges, and its bonds
// with orders. What every source of a ligand is read into, and what types and charges follow from.
#pragma once
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct GraphAtom {
    std::string name;              // unique in the molecule; empty if the file has none
    std::string element;           // in upper case, "C", "CL"
    int charge = 0;                // formal charge, e
    std::optional<Vec3> position;  // Å
};

struct GraphBond {
    std::uint32_t a, b;
    int order = 1;  // 1 to 3; Kekulé form for aromatic bonds
};

struct MoleculeGraph {
    std::string name;
    std::vector<GraphAtom> atoms;
    std::vector<GraphBond> bonds;

    std::size_t size() const noexcept { return atoms.size(); }
    bool is_hydrogen(std::size_t atom) const noexcept { return atoms[atom].element == "H"; }
};

// Limit of atoms, which bounds the computing time; the largest ligands have about 300 atoms.
inline constexpr std::size_t most_ligand_atoms = 1000;

// For each atom its bonds, as indices into `bonds`.
using BondLists = std::vector<std::vector<std::uint32_t>>;
BondLists bonds_of_atoms(const MoleculeGraph& graph);

// The atom at the other end.
inline std::uint32_t other_end(const GraphBond& bond, std::uint32_t atom) noexcept {
    return bond.a == atom ? bond.b : bond.a;
}

// The sum of the formal charges, e.
int total_charge(const MoleculeGraph& graph);

// The molecule without the marked atoms and their bonds.
MoleculeGraph without_atoms(const MoleculeGraph& graph, const std::vector<bool>& left_out);

}  // namespace palpa
