// Force field files as commands take them.
#pragma once
#include "charmm/force_field.h"

#include <filesystem>
#include <vector>

namespace palpa {

// The files, each folder as list_force_field_files has it.
std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& paths);

// Warnings on the error output about what was read, a line for each kind.
void warn_of_notes(const ForceField& force_field);

}  // namespace palpa
