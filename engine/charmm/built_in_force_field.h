// CHARMM36 as it comes with the program: a packed force field beside it.
#pragma once
#include "charmm/force_field.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Where it is: installed beside the program, or in the source tree of a build. Throws LoadError
// where there is none.
std::filesystem::path find_built_in_force_field();

// It, and in place of what it has or beside it what `files` say.
ForceField read_built_in_force_field(std::span<const std::filesystem::path> files = {});

}  // namespace palpa
