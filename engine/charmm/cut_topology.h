// Cuts atoms out of a topology.
#pragma once
#include "charmm/topology.h"

#include <cstdint>
#include <span>

namespace palpa {

// Takes these atoms of a topology, rising, with the terms, exclusions and pairs three bonds apart
// among them: what reaches out is left out. Pairs stay excluded though the bonds that join them be
// cut. Tables of types and maps stay whole, and solvation goes along.
Topology cut_topology(const Topology& whole, std::span<const std::uint32_t> atoms);

}  // namespace palpa
