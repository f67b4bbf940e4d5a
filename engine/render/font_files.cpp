#include "render/font_files.h"

#include <cstdlib>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

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
    for (const char* const file : usual_files)
        if (is_file(file)) files.emplace_back(file);
    return files;
}

}  // namespace palpa
