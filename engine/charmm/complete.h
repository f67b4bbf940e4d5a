// Adds the atoms that templates and patches require, and finds the internal coordinates from which
// they can be placed.
#pragma once
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "molecule/atoms.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa {

// A structure with all atoms that `build_connectivity` requires.
struct CompletedStructure {
    // The given atoms in their order; behind the last given atom of a residue those that it lacked,
    // in the order of its template and its patches, with positions of NaN.
    Structure structure;
    std::vector<std::uint32_t> added;  // atoms without a position, ascending
};

// Adds what is missing; refuses, as `build_connectivity` does, whatever else is wrong with
// residues, patches and names, all of it gathered in one LoadError. Lines (and records) of added
// atoms are those of the residue's first atom, the element that of the type.
CompletedStructure add_missing_atoms(const ForceField& force_field, const Structure& structure,
                                     const GenerateSettings& settings = {});

// A line of an IC table (InternalCoordinate in charmm/force_field.h) whose four atoms are found.
struct AtomCoordinate {
    std::array<std::uint32_t, 4> atoms;
    bool is_improper = false;  // improper: the third atom is bonded to the other three
    double first_bond = 0;     // Å, 0-1; 0-2 of an improper; 0: the file leaves it open
    double first_angle = 0;    // rad, 0-1-2; 0-2-1 of an improper
    double dihedral = 0;       // rad, 0-1-2-3
    double last_angle = 0;     // rad, 1-2-3
    double last_bond = 0;      // Å, 2-3
};

// Of all residues and patches, patches first: what they say holds before what the template says.
// Lines that name an atom which is not there are left out. The structure must have all its atoms;
// their positions do not matter.
std::vector<AtomCoordinate> find_internal_coordinates(const ForceField& force_field,
                                                      const Structure& structure,
                                                      const GenerateSettings& settings = {});

}  // namespace palpa
