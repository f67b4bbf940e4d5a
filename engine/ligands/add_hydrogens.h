// Adds hydrogens to a molecule of heavy atoms, with charges at pH 7.4.
#pragma once
#include "ligands/graph.h"

#include <string>
#include <vector>

namespace palpa {

// Formal charges of heavy atoms at pH 7.4. Carboxylic, phosphoric, phosphonic and sulphonic acids
// give their protons away; amidines and guanidines whose nitrogens are on hydrogen and saturated
// carbon alone take one. So do amines on saturated carbon if the pKa is above 7.4: 10.6 of primary,
// 11 of secondary, 10 of tertiary ones, less by the effects of what is near (Perrin, Dempsey and
// Serjeant, pKa prediction for organic acids and bases, 1981, rounded): 2.5 for a carbonyl on the
// carbon beside it, 1.2 for an aromatic ring there; for atoms one bond further 1 for O, S or N, 4
// for a charged N, 1.6 for F, 0.8 for a carbonyl. The strongest base first. Hydrogens in the graph
// do not count; what was decided is added to `notes`, a phrase each.
void charge_at_ph_7(MoleculeGraph& graph, std::vector<std::string>& notes);

// Takes all hydrogens away and adds what valences and charges ask for, without positions: names are
// those of the hydrogens that the heavy atom had, then H1, H2, and so on. A nitro group with two
// double bonds becomes the charged form first.
MoleculeGraph with_hydrogens(const MoleculeGraph& graph);

}  // namespace palpa
