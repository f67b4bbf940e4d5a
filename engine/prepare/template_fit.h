// Checks whether a residue of the force field is the molecule of this name in a file.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "prepare/residues.h"

#include <string>

namespace palpa {

// Chains, water and single atoms have their names for that. Of other molecules all heavy atoms must
// find their place in the template, by name or by bonds; where a table says what the residue is
// (`is_vouched`), names are enough for a part of it.
bool is_template_of(const ForceField& force_field, const std::string& name,
                    const Structure& structure, const ResidueRange& residue, bool is_vouched);

// Whether all elements of the force field's residue are there: HIP of AMBER is a histidine, that of
// CHARMM a phosphohistidine.
bool has_elements_of(const ForceField& force_field, const std::string& name,
                     const Structure& structure, const ResidueRange& residue);

}  // namespace palpa
