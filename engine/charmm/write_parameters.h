// Writes CHARMM parameter files.
#pragma once
#include "charmm/force_field.h"

#include <string>
#include <string_view>

namespace palpa {

// All parameters of the force field as text of a .prm file that reads back to the same numbers:
// types with masses, bonds, angles, dihedrals, impropers, CMAP, non-bonded, NBFIX. Residues and
// patches are not written. `title`: lines without the leading '*'.
std::string format_parameters(const ForceField& force_field, std::string_view title);

}  // namespace palpa
