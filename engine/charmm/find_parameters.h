// Finds the entry of a force field for given atom types.
#pragma once
#include "charmm/force_field.h"

#include <array>
#include <string>
#include <vector>

namespace palpa {

template <std::size_t Size>
using Types = std::array<std::string, Size>;

// Null if there is none; the rules are in charmm/build_topology.h. The results point into the force
// field.
const HarmonicParameter* find_bond(const ForceField& force_field, const Types<2>& types);
const AngleParameter* find_angle(const ForceField& force_field, const Types<3>& types);
const std::vector<DihedralTerm>* find_improper(const ForceField& force_field,
                                               const Types<4>& types);
const CmapParameter* find_cmap(const ForceField& force_field, const Types<8>& types);

// Across an angle of 180 degrees no entry is needed: then the result has no terms.
const std::vector<DihedralTerm>* find_dihedral(const ForceField& force_field,
                                               const Types<4>& types);

}  // namespace palpa
