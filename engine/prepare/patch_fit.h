// Checks whether a patch fits a residue.
#pragma once
#include "charmm/force_field.h"

#include <string>

namespace palpa {

// The first atom that shows that a patch of one residue is not for this one: deleted or changed
// without being there, or neither there nor bonded by the patch. Empty if it fits.
std::string find_misfit(const Residue& residue, const Residue& patch);

}  // namespace palpa
