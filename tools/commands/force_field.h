// palpa force-field: the force field that comes with the program, and packing one.
#pragma once
#include "charmm/force_field.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace palpa {

struct ForceFieldOptions {
    std::string what;  // "pack", "show"
    std::vector<std::filesystem::path>
        files;  // CHARMM's, or folders of them; to show: a packed one
    std::optional<std::filesystem::path> output, about;
    bool overwrites = false;  // an earlier packed file
    bool json = false;
};

// Throws LoadError on bad input. Returns the exit code.
int force_field_command(const ForceFieldOptions& options);

// The files, each folder as list_force_field_files has it.
std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& paths);

// Warnings on the error output about what was read, a line for each kind.
void warn_of_notes(const ForceField& force_field);

}  // namespace palpa
