#include "app/recovery.h"

#include "app/preferences.h"
#include "core/files.h"
#include "core/text.h"
#include "platform/program.h"
#include "session/save_scene.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_files = 300;

// Beside the folder of prepared scenes.
std::optional<fs::path> find_folder() {
    const std::optional<fs::path> prepared = find_prepared_folder();
    if (!prepared) return std::nullopt;
    return prepared->parent_path() / "recovered";
}

// "TITLE-1234.toml": the number is the process's.
std::optional<std::uint64_t> find_process(const fs::path& file) {
    const std::string name = file.stem().string();
    const std::size_t dash = name.rfind('-');
    if (file.extension() != ".toml" || dash == std::string::npos) return std::nullopt;
    const std::optional<std::int64_t> number = find_integer(name.substr(dash + 1));
    if (!number || *number <= 0) return std::nullopt;
    return static_cast<std::uint64_t>(*number);
}

// Whoever has unsaved changes writes them every 20 seconds; a number may be another process's by
// now.
bool is_in_use(const fs::path& file, std::uint64_t process) {
    constexpr std::chrono::minutes silence{2};
    std::error_code error;
    const fs::file_time_type written = fs::last_write_time(file, error);
    return is_process_running(process) && !error &&
           fs::file_time_type::clock::now() - written < silence;
}

}  // namespace

RecoveryFile::RecoveryFile() : folder_(find_folder()) {}

void RecoveryFile::forget() noexcept {
    if (file_) forget_recovered(*file_);
    file_.reset();
}

void RecoveryFile::save(const World& world, const ViewDescription& view) noexcept {
    if (!folder_) return;
    try {
        fs::create_directories(*folder_);
        const fs::path scene = world.resource<ScenePlaces>().file;
        const fs::path file =
            *folder_ / fmt::format("{}-{}.toml", scene.parent_path().filename().string(),
                                   own_process_number());
        save_scene(world, view, file, "A backup in case the program ends unexpectedly.",
                   Existing::Replace);
        file_ = file;
    } catch (const std::exception&) {  // a full disk may have room the next time
        return;
    }
}

void forget_recovered(const fs::path& file) noexcept {
    std::error_code error;
    for (const fs::path& saved : list_scene_files(file)) fs::remove(saved, error);
}

std::vector<fs::path> list_recovered() {
    std::vector<fs::path> files;
    const std::optional<fs::path> folder = find_folder();
    if (!folder) return files;
    for (const fs::path& file : list_folder(*folder, most_files)) {
        const std::optional<std::uint64_t> process = find_process(file);
        if (process && !is_in_use(file, *process)) files.push_back(file);
    }
    const auto written = [](const fs::path& file) {
        std::error_code error;
        return fs::last_write_time(file, error);
    };
    std::ranges::sort(files, std::ranges::greater{}, written);
    return files;
}

bool is_recovered(const fs::path& file) {
    const std::optional<fs::path> folder = find_folder();
    return folder && file.parent_path() == *folder;
}

}  // namespace palpa
