#include "charmm/force_field.h"
#include "core/files.h"

#include <fmt/format.h>
#include <array>
#include <string_view>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

void add_files_of(const fs::path& folder, std::vector<fs::path>& files) {
    const std::vector<fs::path> there = list_folder(folder);
    for (const std::string_view ending : {".rtf", ".prm", ".str"}) {
        for (const fs::path& path : there) {
            if (path.extension() == ending) files.push_back(path);
        }
    }
}

}  // namespace

std::vector<fs::path> list_force_field_files(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) return {path};
    std::vector<fs::path> files;
    add_files_of(path, files);
    for (const fs::path& below : list_folder(path)) {
        if (fs::is_directory(below, error)) add_files_of(below, files);
    }
    if (!files.empty()) return files;
    throw LoadError({path.string()},
                    "this folder contains no force field files; expected .rtf, .prm or .str");
}

}  // namespace palpa
