// Reduces a force field to the parameters that one system needs.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <span>

namespace palpa {

// A force field of parameters only, for which `build_topology` gives the same result as for the
// whole one. Parameters that are missing stay missing.
ForceField keep_used_parameters(const ForceField& force_field, const Connectivity& connectivity);

// The same force field without the residues that do not occur in the structure: cheap to change and
// to copy.
ForceField keep_named_residues(const ForceField& force_field, std::span<const AtomName> names);

}  // namespace palpa
