#include "tools/commands/licences.h"

#include "charmm/built_in_force_field.h"
#include "charmm/packed_force_field.h"
#include "core/files.h"
#include "core/version.h"
#include "tools/commands/command.h"

#include <fmt/format.h>
#include <array>
#include <nlohmann/json.hpp>

namespace palpa {
namespace {

constexpr std::array libraries = std::to_array<Library>({
    {"CLI11", "CLI11", "", "BSD-3-Clause", "https://github.com/CLIUtils/CLI11", "the command line"},
    {"Eigen", "Eigen3", "", "MPL-2.0", "https://eigen.tuxfamily.org", "vectors and matrices"},
    {"{fmt}", "fmt", "libfmt", "MIT", "https://fmt.dev", "text"},
    {"FreeType", "Freetype", "libfreetype", "FTL", "https://freetype.org", "words on pictures"},
    {"gemmi", "gemmi", "", "MPL-2.0", "https://project-gemmi.github.io", "the grammar of mmCIF"},
    {"GLFW", "glfw3", "libglfw", "Zlib", "https://www.glfw.org", "the window"},
    {"GLM", "glm", "", "MIT", "https://glm.g-truc.net", "matrices of pictures"},
    {"HIDAPI", "hidapi", "libhidapi-hidraw", "BSD-3-Clause", "https://github.com/libusb/hidapi",
     "game pads, SpaceMouse"},
    {"Highway", "hwy", "libhwy", "Apache-2.0", "https://github.com/google/highway",
     "vector instructions"},
    {"Dear ImGui", "imgui", "", "MIT", "https://github.com/ocornut/imgui", "panels"},
    {"JSON for Modern C++", "nlohmann_json", "", "MIT", "https://json.nlohmann.me", "JSON"},
    {"libpng", "PNG", "libpng16", "libpng-2.0", "http://www.libpng.org", "pictures"},
    {"PEGTL", "tao/pegtl", "", "MIT", "https://github.com/taocpp/PEGTL", "parser, for gemmi"},
    {"SDL", "SDL2", "libSDL2", "Zlib", "https://www.libsdl.org", "sound"},
    {"stb", "", "libstb", "MIT", "https://github.com/nothings/stb", "fonts, for Dear ImGui"},
    {"toml++", "tomlplusplus", "libtomlplusplus", "MIT", "https://marzer.github.io/tomlplusplus",
     "scene files"},
    {"Vulkan loader", "Vulkan", "libvulkan", "Apache-2.0",
     "https://github.com/KhronosGroup/Vulkan-Loader", "drawing"},
    {"zlib", "ZLIB", "libz", "Zlib", "https://zlib.net", "compressed files"},
    {"GNU C++ library", "", "libstdc++ libgcc_s", "GPL-3.0-or-later WITH GCC-exception-3.1",
     "https://gcc.gnu.org", "C++"},
    {"GNU C library", "", "libc libm libdl libpthread", "LGPL-2.1-or-later",
     "https://www.gnu.org/software/libc", "C"},
});

struct LicencesOptions {
    bool json = false;
};

// What the built-in force field says of itself: title, origin, terms, whom to cite.
std::vector<std::string> read_about_force_field() {
    const std::filesystem::path file = find_built_in_force_field();
    return read_packed_about(read_text_file(file), file.string());
}

// Its table is part of the program.
constexpr std::string_view solvation =
    "EEF1-SB: S. Bottaro, K. Lindorff-Larsen, R. B. Best, J. Chem. Theory Comput. 9, 5641 (2013); "
    "EEF1: T. Lazaridis, M. Karplus, Proteins 35, 133 (1999).";

void print_licences_json(const std::vector<std::string>& about) {
    nlohmann::ordered_json json{{"program", {{"version", version_name}, {"licence", "MIT"}}},
                                {"libraries", nlohmann::ordered_json::array()}};
    for (const Library& library : libraries) {
        nlohmann::ordered_json row{{"name", library.name},       {"version", version_of(library)},
                                   {"licence", library.licence}, {"home", library.home},
                                   {"use", library.use},         {"package", library.package},
                                   {"files", library.files}};
        json["libraries"].push_back(std::move(row));
    }
    json["force_field"] = about;
    json["solvation"] = solvation;
    fmt::print("{}\n", json.dump(2));
}

void print_licences(const std::vector<std::string>& about) {
    fmt::print("Palpa {} is under the MIT licence. It uses\n\n", version_name);
    for (const Library& library : libraries) {
        fmt::print("  {:<20} {:<9} {:<22} {:<46} {}\n", library.name, version_of(library),
                   library.use, library.home, library.licence);
    }
    fmt::print("\nThe force field has terms of its own:\n\n");
    for (const std::string& line : about) fmt::print("  {}\n", line);
    fmt::print("\nCite for implicit solvent:\n\n  {}\n", solvation);
}

int licences_command(const LicencesOptions& options) {
    const std::vector<std::string> about = read_about_force_field();
    options.json ? print_licences_json(about) : print_licences(about);
    return 0;
}

}  // namespace

std::span<const Library> list_libraries() { return libraries; }

std::string version_of(const Library& library) {
    for (const FoundVersion& found : list_found_versions()) {
        if (found.package == library.package) return std::string(found.version);
    }
#ifdef _GLIBCXX_RELEASE
    if (library.files.starts_with("libstdc++")) return std::to_string(_GLIBCXX_RELEASE);
#endif
#ifdef __GLIBC__
    if (library.files.starts_with("libc ")) return fmt::format("{}.{}", __GLIBC__, __GLIBC_MINOR__);
#endif
    return {};
}

void add_licences(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& command = *program.add_subcommand(
        "licences", "Libraries of the program with version and licence; whom to cite");
    LicencesOptions& options = own_options<LicencesOptions>(command, chosen, licences_command);
    describe(command, "Look and measure", {"palpa licences", "palpa licences --json"});
    command.add_flag("--json", options.json, "print as JSON");
}

}  // namespace palpa
