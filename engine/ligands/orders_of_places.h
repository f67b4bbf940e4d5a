// Finds bonds and bond orders from atomic positions: the last resort.
#pragma once
#include "ligands/graph.h"

namespace palpa {

// Bonds between atoms with positions: those closer than the sum of their covalent radii
// (molecule/element.h) and 0.4 Å, hydrogens to the one nearest atom. What
// bonds the graph had is dropped; all orders are 1.
void find_bonds(MoleculeGraph& graph);

// Orders of the bonds of a molecule without hydrogens. An atom may have a double bond if it is
// flat: three neighbours whose angles add up to 353 degree, two with an angle above 117 degree (N:
// 108), one, or a place in a ring of five or six that is flat to 0.12 Å. Double are: short bonds to
// an oxygen of one neighbour, those of S, P and nitro groups; bonds of flat rings; other short
// bonds of two flat atoms; the shortest first. Positions must be those of a good crystal structure:
// at 0.1 Å of error some orders come out wrong.
void guess_orders(MoleculeGraph& graph);

}  // namespace palpa
