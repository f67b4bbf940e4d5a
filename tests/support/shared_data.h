// Larger inputs that are not in the repository: the folder that PALPA_DATA names.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

namespace palpa::test {

// The file or folder under PALPA_DATA; without one, ctest is told that the test is skipped.
inline std::optional<std::filesystem::path> find_shared_data(const std::string& name) {
    const char* const folder = std::getenv("PALPA_DATA");
    if (folder && std::filesystem::exists(std::filesystem::path(folder) / name)) {
        return std::filesystem::path(folder) / name;
    }
    std::cout << "SKIPPED: PALPA_DATA names no folder with " << name << "\n";
    return std::nullopt;
}

}  // namespace palpa::test
