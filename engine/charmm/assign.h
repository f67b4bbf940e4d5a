// Gives the atoms of a structure their type, mass, charge and Lennard-Jones parameters.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"

#include <string_view>

namespace palpa {

// Appends the structure's atoms of one segment to the table; returns where they stand. Atoms are
// found in their residue by name, never by order. Everything that is missing (the segment, atoms,
// residues, types, parameters, charge, an NBFIX pair that the scene would need) is gathered before
// a LoadError names it. Pairs count between the new atoms and those that the table holds already,
// which must come from the same force field.
AtomRange add_segment_atoms(const ForceField& force_field, const Structure& structure,
                            std::string_view segment, AtomTable& table);

}  // namespace palpa
