// Nucleic acids of a cartoon: a ribbon from P to P, and plates for bases.
#pragma once
#include "view/cartoon.h"

#include <span>

namespace palpa {

// Adds chains of two nucleotides or more and records them in `parts`.
void add_nucleic_acids(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                       std::span<const glm::vec3> colours, const CartoonDetail& detail,
                       MeshShape& mesh, CartoonParts& parts);

}  // namespace palpa
