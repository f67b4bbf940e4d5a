// Protein Data Bank files (.pdb, .ent), format 3.3, by their fixed columns.
#pragma once
#include "molecule/atoms.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace palpa {

// Reads ATOM, HETATM, TER, MODEL, ENDMDL, END, LINK, SSBOND and the assemblies of REMARK 350;
// leaves out the other records of the format. Compressed files are unpacked. An atom's segment is
// columns 73 to 76, or the chain where they are blank. Residue names may have four letters
// (CHARMM's). An element that is missing is guessed from the name. Blank occupancy is 1, blank
// B-factor 0.
//
// Numbers that outgrow their columns are taken as other programs write them: serials and residue
// numbers in hybrid-36 ("A0000") or hexadecimal ("186a0"), serials as stars, with a sixth digit on
// either side or starting over; residue numbers with a fifth digit in the column of the insertion
// code, or starting over with 0 behind 9999, which are counted on.
//
// Throws LoadError with line and columns of what is wrong: a value that does not parse or a blank
// within it, a line that ends before its coordinates, an unknown element, an atom that comes again
// in another residue or in more than 50 cases (else the first is taken and the others noted),
// a model that is not closed, a record that looks like a misspelt ATOM, a file without atoms.
Structure read_pdb(const std::filesystem::path& path);
Structure parse_pdb(std::string_view text, const std::string& file);

// With TER behind each chain, MODEL around each model unless there is only a model 1, numbers
// beyond their columns in hybrid-36. Without `records` (a structure from a CRD file) chain and
// element stay blank. `title`: lines without REMARK. Throws LoadError where a name, a residue
// number or a coordinate does not fit its columns.
std::string format_pdb(const Structure& structure, std::string_view title);

// Replaces longer chain names by unused letters, because a PDB file has one column for them.
Structure with_short_chains(Structure structure);

}  // namespace palpa
