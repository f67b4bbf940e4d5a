// Reads and writes protein structure files (.psf) of CHARMM, X-PLOR and NAMD.
#pragma once
#include "molecule/connectivity.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace palpa {

// The first line names the dialect: EXT (wider columns), CMAP (cross-terms at the end), XPLOR or
// NAMD (types by name; without either CHARMM writes them as numbers, and both are taken), CHEQ (two
// more numbers an atom). Fields are separated by the blanks between them. Donors, acceptors,
// groups and explicit exclusions are checked and left out; lone pairs and polarisable atoms are
// refused. Throws LoadError with the line of what is wrong: a number that does not parse, an index
// of no atom, a count that is not met, a section that is missing or comes twice, two atoms of one
// name, a bond that comes twice or goes nowhere.
Connectivity read_psf(const std::filesystem::path& path);
Connectivity parse_psf(std::string_view text, const std::string& file);

// The EXT form with types by name, charges to six decimals. `title`: lines without "REMARKS".
std::string format_psf(const Connectivity& connectivity, std::string_view title);

}  // namespace palpa
