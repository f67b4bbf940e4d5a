// Reads and writes GRO structure files of GROMACS.
#pragma once
#include "molecule/atoms.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

// Whether a residue is water, by the names of CHARMM, GROMACS and others.
bool is_water_residue(std::string_view residue) noexcept;

// A file has one frame; velocities and the box are left out. Coordinates may have more digits, as
// GROMACS writes them: found from the distance of the decimal points. A GRO file has no segments:
// here each is a run of atoms, WAT (and WAT2, ...) of water, ION of residues of one atom, and M1,
// M2,
// ... of the rest, where the next one begins where a residue's number is lower than that before it.
// Throws LoadError with the line of what is wrong.
Structure read_gro(const std::filesystem::path& path);
Structure parse_gro(std::string_view text, const std::string& file);

// The fixed columns of GROMACS's reference manual: "%5d%-5s%5s%5d%8.3f%8.3f%8.3f", nm; then the
// box, whose columns are edges, Å: its diagonal, nm, and where it is not rectangular the other six
// of its numbers; zeros without one. Numbers of residues and atoms go on from 0 behind 99999, and
// insertion codes are left out, as GROMACS does. `title`: its first line is written. With more
// `decimals` of coordinates, 3 to 12, columns are so much wider, which GROMACS reads as well.
// Throws LoadError: a name of more than five letters or none, a residue number that is none, a
// coordinate that does not fit its columns, a box whose edge a is not along x and b not in the
// plane of x and y (which GROMACS refuses), several models.
std::string format_gro(const Structure& structure, std::string_view title,
                       const std::optional<Mat3>& box = {}, int decimals = 3);

}  // namespace palpa
