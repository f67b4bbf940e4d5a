// Reduces the charge of nucleic acid phosphates in vacuum.
#pragma once
#include "molecule/connectivity.h"

#include <cstddef>
#include <span>

namespace palpa {

// Net charge of a phosphate group in vacuum (e): it stands for the counterions that are missing
// there, without which the strands of a duplex drive each other apart. B. Tidor, K. K. Irikura,
// B. R. Brooks, M. Karplus, J. Biomol. Struct. Dyn. 1, 231 (1983).
inline constexpr double reduced_phosphate_charge = -0.32;

// By which charges are divided where phosphates are reduced. Measured on the 19 base pairs of 1D66
// at rest, of 59.9 Å and 623° of twist: 55 Å and 665°. With a dielectric of 1 they are drawn out
// to 80 Å and 485°, and lose their stacking.
inline constexpr double nucleic_dielectric = 4;

// Raises the charges of the two free oxygens of every phosphate that joins two residues by equal
// amounts, from a net charge of -1 to the reduced one. Returns how many phosphates there are; those
// of lipids and free nucleotides, which lie within one residue, stay as they are. `charge`: one an
// atom.
std::size_t reduce_phosphates(const Connectivity& connectivity, std::span<double> charge);

}  // namespace palpa
