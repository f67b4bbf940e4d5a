// The built-in force field: CHARMM36 as a packed file beside the program.
#pragma once
#include "charmm/force_field.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Path of the file: installed beside the program, or in the source tree of a build. Throws
// LoadError if it is missing.
std::filesystem::path find_built_in_force_field();

// Reads it, then `files`, which add to it or replace entries of it.
ForceField read_built_in_force_field(std::span<const std::filesystem::path> files = {});

}  // namespace palpa
