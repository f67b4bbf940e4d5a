// Finds the charge groups of a structure from templates and patches.
#pragma once
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <cstdint>
#include <string>
#include <vector>

namespace palpa {

// Which atoms are a charge group together: those of a GROUP of a residue's template; where a patch
// has atoms of its own in a GROUP, those and whole groups of which it takes atoms. Atoms rise
// within a group, and groups by their first atom. The structure is one that build_connectivity
// takes with these settings.
std::vector<std::vector<std::uint32_t>> find_charge_groups(const ForceField& force_field,
                                                           const Structure& structure,
                                                           const GenerateSettings& settings);

// Groups with a charge above 0.001 e, as "A ASP 25, CB HB1 HB2 CG OD1 OD2: -1.00 e".
std::vector<std::string> find_charged_groups(const Connectivity& connectivity,
                                             const std::vector<std::vector<std::uint32_t>>& groups);

}  // namespace palpa
