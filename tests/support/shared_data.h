// Larger inputs that are not in the repository: the folder that PALPA_DATA names.
#pragma once
#include "tests/support/skip.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace palpa::test {

// The file or folder under PALPA_DATA; without it the test is skipped.
inline std::optional<std::filesystem::path> find_shared_data(const std::string& name) {
    const char* const folder = std::getenv("PALPA_DATA");
    if (folder && std::filesystem::exists(std::filesystem::path(folder) / name)) {
        return std::filesystem::path(folder) / name;
    }
    skip("PALPA_DATA names no folder with " + name);
    return std::nullopt;
}

}  // namespace palpa::test
