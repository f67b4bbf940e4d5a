#include "charmm/built_in_force_field.h"

#include "platform/program.h"

#include <fmt/format.h>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;
constexpr const char* file_name = "charmm36.ff";

}  // namespace

fs::path find_built_in_force_field() {
    const fs::path program = find_program_file().parent_path();
    const fs::path installed =
        (program / PALPA_SHARE / "force-field" / file_name).lexically_normal();
    std::error_code error;
    if (fs::is_regular_file(installed, error)) return installed;
    const fs::path builds = program.parent_path().parent_path();  // build/PRESET/bin
    if (builds.filename() == "build") {
        const fs::path source = builds.parent_path() / "engine" / "charmm" / file_name;
        if (fs::is_regular_file(source, error)) return source;
    }
    throw LoadError({installed.string()},
                    "the built-in force field is missing; expected this file beside the program, "
                    "or --only-toppar with CHARMM's files");
}

ForceField read_built_in_force_field(std::span<const fs::path> files) {
    std::vector<fs::path> all{find_built_in_force_field()};
    all.insert(all.end(), files.begin(), files.end());
    return read_force_field(all);
}

}  // namespace palpa
