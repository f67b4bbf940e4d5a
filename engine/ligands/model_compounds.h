// The model compounds of a force field, from which types, charges and impropers of unknown
// molecules are derived.
#pragma once
#include "charmm/force_field.h"
#include "ligands/environments.h"
#include "ligands/graph.h"
#include "ligands/perception.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct ModelCompound {
    std::string name;
    MoleculeGraph graph;
    Perceived seen;
    std::vector<EnvironmentKeys> keys;  // one for each atom, as all arrays here
    std::vector<std::string> types;
    std::vector<double> charges;     // e
    std::vector<bool> has_improper;  // whether it is the first atom of an improper
};

// The element of a type of CGenFF, by its name: "C" of "CG331", "CL" of "CLGR1". Empty: it is none.
std::string_view element_of_cgenff_type(std::string_view type) noexcept;

// A residue as a molecule. Lone pairs become part of the atom that they are on. None for residues
// that are bonded to others, whose types are not all CGenFF's, or whose valences do not add up to
// their charge.
std::optional<ModelCompound> find_model_compound(const ForceField& force_field,
                                                 const std::string& name);

// All model compounds in the order of their names, except `withheld`.
std::vector<ModelCompound> find_model_compounds(const ForceField& force_field,
                                                const std::vector<std::string>& withheld = {});

}  // namespace palpa
