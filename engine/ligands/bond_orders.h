// Bond orders and formal charges of a molecule whose atoms, hydrogens included, and bonds are
// known.
#pragma once
#include "ligands/graph.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace palpa {

// Sets `order` of every bond and `charge` of every atom. Each atom has a usual valence: C 4, N 3 (4
// with four neighbours, in nitro groups and N-oxides), O 2, S 2, 4 or 6, P 3 or 5, halogens 1. What
// its neighbours leave open is paired along bonds, carbon first, so that charges are left to N, S
// and O. An atom that stays open is an anion; an open carbon beside a nitrogen of three neighbours
// makes that a cation (amidinium, imidazolium, pyridinium). Returns whether every carbon is
// satisfied: where one is not, a hydrogen is missing or the molecule is a radical.
bool assign_bond_orders(MoleculeGraph& graph);

// The same where only some bonds may become double: those marked. Orders of the others count.
// Formal charges are left as they are. Returns whether all atoms of marked bonds that could take
// part are satisfied. For what files call aromatic.
bool pair_marked_bonds(MoleculeGraph& graph, const std::vector<bool>& marked,
                       const std::vector<int>& open);

// The valence of an uncharged atom of this element with so many electrons' worth of bonds: the
// least usual one that is not below. 0: the element has none that is known.
int usual_valence(std::string_view element, int bonds) noexcept;

// Formal charges that follow from orders where all hydrogens are there.
void charge_by_valence(MoleculeGraph& graph);

}  // namespace palpa
