// The few parameters that one system needs of a whole force field.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <span>

namespace palpa {

// A force field of parameters only, with which `build_topology` makes the same of this structure as
// with the whole one; an entry that it would not take is not there. Parameters that are missing
// stay missing.
ForceField keep_used_parameters(const ForceField& force_field, const Connectivity& connectivity);

// The same force field without the residues that no atom of the structure stands in, which are most
// of a large one: cheap to change and to give back.
ForceField keep_named_residues(const ForceField& force_field, std::span<const AtomName> names);

}  // namespace palpa
