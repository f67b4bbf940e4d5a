// Gives the atoms of a structure their type, mass, charge and Lennard-Jones parameters.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <string_view>

namespace palpa {

// Appends the structure's atoms of one segment to the table; returns where they stand. Charges and
// types come from the force field's residues, where atoms are found by name, never by order.
// Everything that is missing (the segment, atoms, residues, types, parameters, charge) is gathered
// before a LoadError names it.
AtomRange add_segment_atoms(const ForceField& force_field, const Structure& structure,
                            std::string_view segment, AtomTable& table);

// The same with types, charges, masses and bonds of a connectivity, in its order; only the
// coordinates come from the structure, by segment, residue number, residue and atom name. Types may
// be names or the numbers of MASS lines. Bonds to other segments are left out.
AtomRange add_segment_atoms(const ForceField& force_field, const Connectivity& connectivity,
                            const Structure& structure, std::string_view segment, AtomTable& table);

}  // namespace palpa
