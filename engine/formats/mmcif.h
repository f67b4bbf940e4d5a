// Macromolecular CIF files (.cif, .mmcif) of the Protein Data Bank: atoms and assemblies.
#pragma once
#include "molecule/atoms.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace palpa {

// Reads the table _atom_site of the one data block that has it, in any order of its columns and
// lines. Names, chain and residue number are the author's (auth_*), as in a PDB file, or where the
// file gives none the archive's (label_*); the segment is the chain. A chain ends where
// label_asym_id changes. '?' and '.' count as not given: occupancy is then 1, B-factor 0, the
// element guessed from the name; a position must be given.
// Biological assemblies are those of _pdbx_struct_assembly_gen and _pdbx_struct_oper_list, bonds
// between residues those of _struct_conn. Compressed files are unpacked. Throws LoadError with the
// line of what is wrong: text that is no CIF, a value that does not parse, a missing or repeated
// column, a row that is not complete, an unknown element, an atom that comes again in another
// residue or in more than 50 cases (else the first is taken and the others noted), a file without
// atoms.
Structure read_mmcif(const std::filesystem::path& path);
Structure parse_mmcif(std::string_view text, const std::string& file);

// The table _atom_site in a data block `name` (letters, digits, '_' and '-'; others become '_'):
// positions to five decimals, all names, numbers and models as wide as they are. Chains are the
// structure's label_chain, or else are named A to Z, AA and so on from one end of a chain to the
// next. Without `records` (a structure from a CRD file) the author's chain is the segment, elements
// are guessed and one model is written. Throws LoadError where a name cannot be written, an element
// cannot be guessed, or a residue number is none.
std::string format_mmcif(const Structure& structure, std::string_view name);

}  // namespace palpa
