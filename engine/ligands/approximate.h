// Makes an approximate residue for a molecule without parameters: types, charges and parameters of
// CGenFF by similarity to known residues.
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

// The model, built once from a force field's residues.
struct LigandModel {
    std::vector<ModelCompound> compounds;
    TypeLibrary types;
    ChargeModel charges;
    TypeDistances distances;
};

// Residues in `withheld` are ignored. Throws LoadError if the force field has no CGenFF residues.
LigandModel build_ligand_model(const ForceField& force_field,
                               const std::vector<std::string>& withheld = {});

struct ApproximateLigand {
    std::string name;    // name of the residue
    std::string source;  // source of bond orders and hydrogens, a phrase
    MoleculeGraph graph;
    std::vector<TypeChoice> types;  // one for each atom
    std::vector<double> charges;    // e
    Residue residue;
    std::vector<Analogy> analogies;
    // Bonds that could turn, but about which a dihedral of high penalty acts.
    std::vector<std::array<std::uint32_t, 2>> doubtful_turns;
    std::vector<std::string> notes;  // decisions, one sentence each
};

// Types and charges of a molecule with all its hydrogens, names unique. Adds the residue, and the
// parameters that are missing, to the force field. Throws LoadError for an element that CGenFF has
// no type for, and for a residue that is there already.
ApproximateLigand approximate_ligand(const MoleculeGraph& graph, const LigandModel& model,
                                     ForceField& into);

// The residue and the added parameters as a CHARMM stream file, with penalties in comments.
std::string format_stream(const ApproximateLigand& ligand, const ForceField& force_field);

// Lines for a report: a summary, uncertain parts, and a table of atoms.
std::vector<std::string> describe(const ApproximateLigand& ligand);

// Advice: where to get parameters of the CGenFF program.
inline constexpr std::string_view real_parameters_advice =
    "for real parameters send the molecule to the CGenFF server (cgenff.com) and give its stream "
    "file with --parameters";

}  // namespace palpa
