// Builds the connectivity of a structure as it was read from a file.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

namespace palpa {

// As build_connectivity (charmm/generate.h), with clear messages for structures with alternate
// locations or without hydrogens. Throws LoadError.
Connectivity type_structure(const ForceField& force_field, const Structure& structure);

}  // namespace palpa
