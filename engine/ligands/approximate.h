// A residue with CGenFF's types, charges and parameters for a molecule that no force field has:
// approximately, by likeness to the residues that there are.
#pragma once
#include "charmm/force_field.h"
#include "ligands/analogy.h"
#include "ligands/charge_model.h"
#include "ligands/graph.h"
#include "ligands/model_compounds.h"
#include "ligands/type_library.h"
#include "ligands/type_traits.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// What is learnt once from a force field's residues.
struct LigandModel {
    std::vector<ModelCompound> compounds;
    TypeLibrary types;
    ChargeModel charges;
    TypeDistances distances;
};

// Residues named in `withheld` are not looked at. Throws LoadError where the force field has none
// of CGenFF's residues.
LigandModel build_ligand_model(const ForceField& force_field,
                               const std::vector<std::string>& withheld = {});

struct ApproximateLigand {
    std::string name;    // of the residue
    std::string source;  // where bond orders and hydrogens are from, a phrase
    MoleculeGraph graph;
    std::vector<TypeChoice> types;  // of each atom
    std::vector<double> charges;    // e
    Residue residue;
    std::vector<Analogy> analogies;
    // Bonds that could turn, but about which a dihedral of high penalty acts.
    std::vector<std::array<std::uint32_t, 2>> doubtful_turns;
    std::vector<std::string> notes;  // what was decided on the way, a sentence each
};

// Types and charges of a molecule with all its hydrogens, names unique. Adds the residue, and the
// parameters that are missing, to the force field. Throws LoadError for an element that CGenFF has
// no type for, and for a residue that is there already.
ApproximateLigand approximate_ligand(const MoleculeGraph& graph, const LigandModel& model,
                                     ForceField& into);

// The residue and the added parameters as a CHARMM stream file, penalties in comments.
std::string format_stream(const ApproximateLigand& ligand, const ForceField& force_field);

// Lines for a report: a summary, what is doubtful, and a table of atoms.
std::vector<std::string> describe(const ApproximateLigand& ligand);

// What helps: where real parameters come from.
inline constexpr std::string_view real_parameters_advice =
    "for real parameters send the molecule to the CGenFF server (cgenff.com) and give its stream "
    "file with --parameters";

}  // namespace palpa
