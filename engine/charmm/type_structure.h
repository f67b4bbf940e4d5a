// What is bonded in a structure as it came from a file.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

namespace palpa {

// As build_connectivity (charmm/generate.h). Says in a line of its own that several locations of an
// atom are given, or that all hydrogens are missing. Throws LoadError.
Connectivity type_structure(const ForceField& force_field, const Structure& structure);

}  // namespace palpa
