// Whether the atoms of a structure are those that its residues should have.
#pragma once
#include "charmm/force_field.h"
#include "charmm/missing.h"
#include "charmm/residue_instances.h"
#include "molecule/atoms.h"

namespace palpa {

// Notes what is wrong with the atoms of settled residues: some that no template knows, some that
// are lacking (unless they may), types that there are not, templates that name what there is not,
// bonds longer than `longest_bond`.
void check_residues(const ForceField& force_field, const Structure& structure,
                    const ResidueInstances& residues, bool may_lack, Missing& missing);

}  // namespace palpa
