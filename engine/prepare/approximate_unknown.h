// Makes approximate residues for ligands that the force field lacks, on request.
#pragma once
#include "charmm/force_field.h"
#include "core/load_error.h"
#include "molecule/atoms.h"
#include "prepare/report.h"
#include "prepare/settings.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpa {

// An approximate residue of a prepared system, for programs and for the scene.
struct ApproximatePart {
    std::string residue;      // "MK1"
    std::string source;       // source of its bonds and hydrogens
    int charge = 0;           // e
    double type_penalty = 0;  // mean over its atoms, see ligands/type_library.h
    double highest_penalty =
        0;  // highest penalty of its parameters by analogy, see ligands/analogy.h
    std::size_t analogies = 0;
    std::vector<std::vector<std::string>>
        rigid_bonds;     // names of two atoms; bonds with uncertain barriers
    std::string stream;  // the residue and its new parameters as a CHARMM stream file
};

struct ApproximatedUnknown {
    ForceField force_field;  // with the new residues and parameters
    Structure structure;     // without hydrogens that the new residues do not have
    std::vector<ApproximatePart> parts;
    std::vector<LoadError> refused;  // why other residues stay unknown
};

// Takes each residue that is unknown under all its names (prepare/residue_names.h), of at least two
// heavy atoms and not bonded to others, from the first of its copies with most atoms. Throws
// LoadError where the force field has no CGenFF, and for a --ligand file that fits none of them.
ApproximatedUnknown approximate_unknown(const ForceField& force_field, const Structure& structure,
                                        const PrepareSettings& settings, Report& report);

}  // namespace palpa
