// Assigns EEF1's solvation parameters to atoms by their types.
#pragma once
#include "charmm/force_field.h"
#include "charmm/solvation.h"
#include "charmm/solvation_reader.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// One entry per atom, in the order of the atoms. Volume, energies and lambda are the table's; the
// radius is Rmin/2 of the atom's own type. Hydrogens (lighter than 3.5 amu) count for nothing.
// `is_structural`, one entry per atom or none at all: oxygens of waters that count for nothing
// either, beside which no implicit water is counted; marks on other heavy atoms are ignored. Heavy
// types without a row are gathered before a LoadError names each with its first atom: nothing is
// ever taken as 0.
// `place`: of what asks for it.
Solvation assign_solvation(const AtomTable& atoms, const SolvationTable& table,
                           std::span<const std::uint8_t> is_structural, const TextPlace& place);

// The same of a structure, whose types may be numbers of MASS lines. Types that the force field
// does not know throw too.
Solvation assign_solvation(const Connectivity& connectivity, const ForceField& force_field,
                           const SolvationTable& table,
                           std::span<const std::uint8_t> is_structural = {});

// Marks the atoms of waters: residues with one oxygen and two hydrogens. One entry per atom.
std::vector<std::uint8_t> find_water_atoms(std::span<const AtomName> names,
                                           std::span<const double> mass);

// The heavy types of a structure that have no row, each once, in the order of their first atoms, as
// "SS (A CYS 3 SG)"; waters' too unless they are structural.
std::vector<std::string> find_uncovered_types(const Connectivity& connectivity,
                                              const SolvationTable& table,
                                              std::span<const std::uint8_t> is_structural = {});

// The types whose radius, of the force field at hand, is not that of the one that the table was
// made for (0.02 Å), each once, as "CT2 (2.175 Å, not 2.01 Å)". Rows that were assigned by analogy
// have the radius of whoever uses them.
std::vector<std::string> find_other_radii(const Connectivity& connectivity,
                                          const Solvation& solvation, const SolvationTable& table);

// Those types of a structure whose rows were assigned by analogy, each once, with what they are
// assigned to: "CG331: as CT3 (CH3); chosen for TL-3".
std::vector<std::string> find_assigned_types(const Connectivity& connectivity,
                                             const SolvationTable& table);

}  // namespace palpa
