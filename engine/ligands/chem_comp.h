// Reads bonds of a residue from CIF files: the tables _chem_comp_atom and _chem_comp_bond of an
// entry, of the Chemical Component Dictionary and of monomer libraries.
#pragma once
#include "ligands/sdf.h"

#include <optional>
#include <string>
#include <string_view>

namespace palpa {

// The residue of this name; none where the file has no bonds of it. Atoms that bonds alone name are
// there as well, with the element that their name says. Orders SING, DOUB, TRIP, and single,
// double, triple count; all others (aromatic, delocalised) are open. Throws LoadError with line and
// column: text that is no CIF, a bond to an atom that the table of atoms lacks, too many atoms.
std::optional<LigandFile> find_chem_comp(std::string_view text, const std::string& file,
                                         std::string_view name);

}  // namespace palpa
