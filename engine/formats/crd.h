// CHARMM coordinate cards (.crd, .cor), normal and extended.
#pragma once
#include "molecule/atoms.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace palpa {

// Fixed columns as CHARMM writes them (io.doc): a title of '*' lines, the number of atoms, with
// "EXT" behind it for the extended form, then one line an atom. Throws LoadError with the line of
// what is wrong: a number that does not parse, a missing or surplus atom, two atoms of one name.
Structure read_crd(const std::filesystem::path& path);
Structure parse_crd(std::string_view text, const std::string& file);

// The extended form, ten decimals. `title`: lines without the leading '*'. Residues are numbered
// in their order; the residue number of `names` is written as the residue identifier.
std::string format_crd(const Structure& structure, std::string_view title);

}  // namespace palpa
