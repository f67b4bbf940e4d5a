#include "app/screenshots.h"

#include "render/picture.h"

#include <fmt/format.h>
#include <system_error>

namespace palpa {

std::filesystem::path save_screenshot(const std::filesystem::path& folder, const WindowShot& shot) {
    for (int number = 1;; ++number) {
        std::filesystem::path path = folder / fmt::format("palpa-{:04}.png", number);
        std::error_code error;
        if (std::filesystem::exists(path, error)) continue;
        write_png(path, {shot.width, shot.height, shot.rgba, {}, {}});
        return path;
    }
}

}  // namespace palpa
