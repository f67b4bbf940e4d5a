#include "app/screenshots.h"

#include "core/files.h"
#include "render/picture.h"

#include <fmt/format.h>
#include <algorithm>
#include <system_error>

namespace palpa {

std::filesystem::path find_free_name(const std::filesystem::path& folder, const std::string& start,
                                     const std::vector<std::string>& endings) {
    make_folder(folder);
    for (int number = 1;; ++number) {
        const auto name = [&](const std::string& ending) {
            return folder / fmt::format("{}-{:04}{}", start, number, ending);
        };
        std::error_code error;
        const auto is_taken = [&](const std::string& ending) {
            return std::filesystem::exists(name(ending), error);
        };
        if (std::ranges::none_of(endings, is_taken)) return name(endings.front());
    }
}

std::filesystem::path save_screenshot(const std::filesystem::path& folder, const WindowShot& shot) {
    std::filesystem::path path = find_free_name(folder, "palpa", {".png"});
    write_png(path, {shot.width, shot.height, shot.rgba, {}, {}});
    return path;
}

}  // namespace palpa
