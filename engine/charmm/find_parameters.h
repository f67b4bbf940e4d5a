// Which entry of a force field gives some types their numbers.
#pragma once
#include "charmm/force_field.h"

#include <array>
#include <string>
#include <vector>

namespace palpa {

template <std::size_t Size>
using Types = std::array<std::string, Size>;

// Null where there is none; the rules are those of charmm/build_topology.h. What is found stays
// where it is in the force field.
const HarmonicParameter* find_bond(const ForceField& force_field, const Types<2>& types);
const AngleParameter* find_angle(const ForceField& force_field, const Types<3>& types);
const std::vector<DihedralTerm>* find_improper(const ForceField& force_field,
                                               const Types<4>& types);
const CmapParameter* find_cmap(const ForceField& force_field, const Types<8>& types);

// Over an angle of 180 degrees, where no entry is needed, one without terms.
const std::vector<DihedralTerm>* find_dihedral(const ForceField& force_field,
                                               const Types<4>& types);

}  // namespace palpa
