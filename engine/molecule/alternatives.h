// Refuses structures in which an atom has several positions: alternate locations and models.
#pragma once
#include "molecule/atoms.h"

#include <cstddef>

namespace palpa {

// Throws LoadError if an atom occurs more than once, in alternate locations or models, with the
// first two positions and the number of repeated lines.
void refuse_alternatives(const Structure& structure);

// Throws this error for two positions of one atom, `again` after `first`; `count`: number of
// repeated lines.
[[noreturn]] void refuse_alternative(const Structure& structure, std::size_t first,
                                     std::size_t again, std::size_t count = 1);

}  // namespace palpa
