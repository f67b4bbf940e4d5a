// What the program is made of, and under which terms: its libraries, and the force field.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// A library that the program links, or whose headers it compiles.
struct Library {
    std::string_view name;
    std::string_view
        package;             // what CMake finds it by; empty where another library brings it along
    std::string_view files;  // shared libraries that the program links, without what follows the
                             // name, separated by spaces; empty: headers alone
    std::string_view licence;  // SPDX; of several to choose from the one that is used
    std::string_view home;
    std::string_view use;
};

// All of them, those of the compiler and the system last.
std::span<const Library> list_libraries();

// As the program was built with it; empty where that is not known.
std::string version_of(const Library& library);

// What CMake has found, by the names of Library::package: generated.
struct FoundVersion {
    std::string_view package, version;
};
std::span<const FoundVersion> list_found_versions();

}  // namespace palpa
