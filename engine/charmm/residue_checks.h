// Checks that the atoms of a structure are those of its residues' templates.
#pragma once
#include "charmm/force_field.h"
#include "charmm/missing.h"
#include "charmm/residue_instances.h"
#include "molecule/atoms.h"

namespace palpa {

// Notes problems of settled residues: unknown atoms, missing atoms (unless they are allowed),
// unknown types, templates that name missing atoms, and bonds longer than `longest_bond`.
void check_residues(const ForceField& force_field, const Structure& structure,
                    const ResidueInstances& residues, bool may_lack, Missing& missing);

}  // namespace palpa
