#include "render/font_files.h"

#include "platform/program.h"

#include <cstdlib>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// The font of an archive, beside the scenes.
fs::path own_file() {
    return find_program_file().parent_path() / PALPA_SHARE / "fonts/DejaVuSans.ttf";
}

constexpr const char* usual_files[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "C:\\Windows\\Fonts\\segoeui.ttf",
    "/System/Library/Fonts/Helvetica.ttc",
};

bool is_file(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
}

}  // namespace

std::vector<fs::path> list_font_files() {
    std::vector<fs::path> files;
    const char* const own = std::getenv("PALPA_FONT");
    if (own && *own != '\0') {
        if (is_file(own)) files.emplace_back(own);
        return files;
    }
    if (is_file(own_file())) files.push_back(own_file().lexically_normal());
    for (const char* const file : usual_files)
        if (is_file(file)) files.emplace_back(file);
    return files;
}

}  // namespace palpa
