// A force field in one small file, which is read in a few milliseconds: what read_force_field made
// of CHARMM's files, without comments and places.
//
// The file begins with lines of text: packed_mark, what the force field is (`about`), and an empty
// one. Then come two whole numbers on a line, the bytes that follow and those that they expand to,
// and zlib's compressed bytes, which end with its checksum. What those are: packed_fields.h.
#pragma once
#include "charmm/force_field.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

inline constexpr std::string_view packed_mark = "Palpa packed force field 1";

// The bytes of such a file. `about`: its title, then further lines for people: date, origin, what
// to cite. All numbers are kept to the last bit. Throws LoadError where a line of `about` is empty
// or cannot be printed.
std::string pack_force_field(const ForceField& force_field, std::span<const std::string> about);

// Whether these are the first bytes of such a file.
bool is_packed_force_field(std::string_view bytes) noexcept;

// The lines for people, without reading on.
std::vector<std::string> read_packed_about(std::string_view bytes, const std::string& file);

// The force field. `files` of it is the title, and all its places are the name of `file` without
// line; it has no notes. Throws LoadError where the file is cut, damaged or of another version.
ForceField unpack_force_field(std::string_view bytes, const std::string& file);

// The same of what the compressed bytes expand to.
ForceField unpack_fields(std::string_view plain, const std::string& file);

}  // namespace palpa
