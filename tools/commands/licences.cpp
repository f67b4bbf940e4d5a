#include "tools/commands/licences.h"

#include "charmm/built_in_force_field.h"
#include "charmm/packed_force_field.h"
#include "core/files.h"
#include "core/version.h"
#include "platform/system.h"
#include "tools/commands/command.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <array>
#include <ctime>
#include <nlohmann/json.hpp>

namespace palpa {
namespace {

constexpr std::array libraries = std::to_array<Library>({
    {"CLI11", "CLI11", "", "BSD-3-Clause", "https://github.com/CLIUtils/CLI11", "the command line"},
    {"Eigen", "Eigen3", "", "MPL-2.0", "https://eigen.tuxfamily.org", "vectors and matrices"},
    {"{fmt}", "fmt", "libfmt", "MIT", "https://fmt.dev", "text"},
    {"Font Awesome 4.7", "", "", "OFL-1.1", "https://fontawesome.com/v4", "icons"},
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
#ifdef PALPA_CURL
    {"libcurl", "CURL", "", "curl", "https://curl.se/libcurl", "PDB entries by code"},
#endif
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
#ifdef __MINGW32__
    {"mingw-w64 runtime", "", "libmingw32", "ZPL-2.1 AND MIT AND LicenseRef-public-domain",
     "https://www.mingw-w64.org", "C"},
    {"winpthreads", "", "libwinpthread", "MIT AND BSD-3-Clause", "https://www.mingw-w64.org",
     "threads"},
#elif defined(__GLIBC__)
    {"GNU C library", "", "libc libm libdl libpthread", "LGPL-2.1-or-later",
     "https://www.gnu.org/software/libc", "C"},
#endif
});

struct LicencesOptions {
    bool json = false, spdx = false;
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
        nlohmann::ordered_json row{{"name", library.name},
                                   {"version", version_of(library)},
                                   {"licence", library.licence},
                                   {"home", library.home},
                                   {"use", library.use},
                                   {"package", library.package},
                                   {"files", system_name() == "Linux" ? library.files : ""}};
        json["libraries"].push_back(std::move(row));
    }
    json["force_field"] = about;
    json["solvation"] = solvation;
    fmt::print("{}\n", json.dump(2));
}

// SPDX identifiers have letters, digits, "." and "-".
std::string spdx_id(std::string_view name) {
    std::string id = "SPDXRef-";
    for (const char c : name) {
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                              (c >= '0' && c <= '9') || c == '.' || c == '-';
        id += is_plain ? c : '-';
    }
    return id;
}

nlohmann::ordered_json spdx_package(std::string_view name, std::string_view version,
                                    std::string_view licence, std::string_view home) {
    nlohmann::ordered_json row{{"name", name}, {"SPDXID", spdx_id(name)}};
    if (!version.empty()) row["versionInfo"] = version;
    row["downloadLocation"] = "NOASSERTION";
    row["filesAnalyzed"] = false;
    if (!home.empty()) row["homepage"] = home;
    row["licenseConcluded"] = "NOASSERTION";
    row["licenseDeclared"] = licence;
    row["copyrightText"] = "NOASSERTION";
    return row;
}

// A list of parts (SBOM) as SPDX 2.3 has it: https://spdx.github.io/spdx-spec/v2.3.
void print_spdx() {
    const std::string created =
        fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    nlohmann::ordered_json json{
        {"spdxVersion", "SPDX-2.3"},
        {"dataLicense", "CC0-1.0"},
        {"SPDXID", "SPDXRef-DOCUMENT"},
        {"name", fmt::format("palpa-{}", version_name)},
        {"documentNamespace",
         fmt::format("urn:palpa:{}:{}:{}", version_name, commit_name, created)},
        {"creationInfo",
         {{"created", created},
          {"creators",
           nlohmann::ordered_json::array({fmt::format("Tool: palpa-{}", version_name)})}}},
        {"packages",
         nlohmann::ordered_json::array({spdx_package("palpa", version_name, "MIT", "")})},
        {"relationships", nlohmann::ordered_json::array()}};
    const auto relate = [&](std::string_view from, std::string_view how, std::string_view to) {
        json["relationships"].push_back(
            {{"spdxElementId", from}, {"relationshipType", how}, {"relatedSpdxElement", to}});
    };
    relate("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-palpa");
    for (const Library& library : libraries) {
        json["packages"].push_back(
            spdx_package(library.name, version_of(library), library.licence, library.home));
        relate("SPDXRef-palpa", "DEPENDS_ON", spdx_id(library.name));
    }
    fmt::print("{}\n", json.dump(2));
}

void print_licences(const std::vector<std::string>& about) {
    fmt::print("Palpa {} is under the MIT licence. It uses\n\n", version_name);
    for (const Library& library : libraries) {
        fmt::print("  {:<20} {:<9} {:<22} {:<46} {}\n", library.name, version_of(library),
                   library.use, library.home, library.licence);
    }
    fmt::print("\nThe force field, {}, has terms of its own:\n\n",
               find_built_in_force_field().string());
    for (const std::string& line : about) fmt::print("  {}\n", line);
    fmt::print("\nCite for implicit solvent:\n\n  {}\n", solvation);
}

int licences_command(const LicencesOptions& options) {
    if (options.spdx) {
        print_spdx();
        return 0;
    }
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
#ifdef __MINGW32__
    if (library.files == "libmingw32")
        return fmt::format("{}.{}", __MINGW64_VERSION_MAJOR, __MINGW64_VERSION_MINOR);
#elif defined(__GLIBC__)
    if (library.files.starts_with("libc ")) return fmt::format("{}.{}", __GLIBC__, __GLIBC_MINOR__);
#endif
    return {};
}

void add_licences(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& command = *program.add_subcommand(
        "licences", "Libraries of the program with version and licence; whom to cite");
    LicencesOptions& options = own_options<LicencesOptions>(command, chosen, licences_command);
    describe(command, {"palpa licences", "palpa licences --json"});
    command.add_flag("--json", options.json, "print as JSON");
    command.add_flag("--spdx", options.spdx, "print a list of parts (SBOM) as SPDX 2.3 in JSON");
}

}  // namespace palpa
