// Checks that a file's coordinates are plausible.
#pragma once
#include "charmm/topology.h"
#include "molecule/atoms.h"
#include "prepare/report.h"

#include <cstdint>
#include <span>

namespace palpa {

// `is_added`: an entry per atom, not zero for atoms without a position, which are passed over.
// Throws LoadError for atoms closer than 0.5 Å to each other, and for coordinates whose bonds are
// on the whole shorter than 0.7 or longer than 1.5 times what they should be (nm, or other units).
// Warns of single bonds between heavy atoms that are off by more than 0.4 Å, and of amino acids of
// the wrong hand, whose CMAP and improper terms are those of L all the same.
void check_coordinates(const Structure& structure, const Topology& topology,
                       std::span<const std::uint8_t> is_added, Report& report);

}  // namespace palpa
