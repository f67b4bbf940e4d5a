#include "tools/commands/force_field.h"

#include <fmt/format.h>
#include <cstdio>
#include <string>
#include <utility>

namespace palpa {

std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& paths) {
    std::vector<std::filesystem::path> files;
    for (const std::filesystem::path& path : paths) {
        for (std::filesystem::path& file : list_force_field_files(path)) {
            files.push_back(std::move(file));
        }
    }
    return files;
}

void warn_of_notes(const ForceField& force_field) {
    for (const std::string& line : describe_notes(force_field.notes)) {
        fmt::print(stderr, "warning: {}\n", line);
    }
}

}  // namespace palpa
