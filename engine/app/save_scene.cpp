#include "app/save_scene.h"

#include "core/files.h"
#include "core/load_error.h"
#include "platform/file.h"
#include "scene/write_scene.h"

#include <fmt/format.h>
#include <string>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr const char* saved_mark = "# A scene saved from Palpa's window";

fs::path folder_of(const fs::path& file) {
    return file.parent_path().empty() ? fs::path(".") : file.parent_path();
}

// As a file in `folder` names another: what is not below it by its whole path.
std::string name_from(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(file, error), error);
    const fs::path from = fs::weakly_canonical(fs::absolute(folder, error), error);
    const fs::path relative = whole.lexically_relative(from);
    const bool is_below = !relative.empty() && *relative.begin() != "..";
    return (is_below ? relative : whole).generic_string();
}

fs::path find_free_file(const fs::path& folder, const std::string& stem) {
    for (int number = 2;; ++number) {
        fs::path path = folder / fmt::format("{}-{}.toml", stem, number);
        std::error_code error;
        if (!fs::exists(fs::symlink_status(path, error))) return path;
    }
}

}  // namespace

SceneSaver::SceneSaver(const fs::path& scene_file, fs::path fallback)
    : folder_(folder_of(scene_file)),
      fallback_(std::move(fallback)),
      stem_(scene_file.stem().string()) {}

fs::path SceneSaver::save(const SceneDescription& scene) {
    if (!file_ && !may_write(folder_)) folder_ = fallback_;
    const fs::path file = file_ ? *file_ : find_free_file(folder_, stem_);
    const std::string text = fmt::format(
        "{}, every key written out.\n{}", saved_mark,
        format_scene(scene, [this](const fs::path& named) { return name_from(folder_, named); }));
    write_text_file(file, text, file_ ? Existing::Replace : Existing::Refuse);
    file_ = file;
    return file;
}

}  // namespace palpa
