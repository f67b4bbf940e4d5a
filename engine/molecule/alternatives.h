// Atoms that a structure file puts in several places: alternate locations and models.
#pragma once
#include "molecule/atoms.h"

#include <cstddef>

namespace palpa {

// Throws LoadError if an atom is there more than once, in alternate locations or models: the first
// one's two places, and how many lines there are too many. Someone has to choose.
void refuse_alternatives(const Structure& structure);

// The same for two places of one atom, `again` behind `first`; `count`: of such lines.
[[noreturn]] void refuse_alternative(const Structure& structure, std::size_t first,
                                     std::size_t again, std::size_t count = 1);

}  // namespace palpa
