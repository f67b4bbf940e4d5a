#include "tools/commands/study_files.h"

#include "core/load_error.h"
#include "core/version.h"
#include "session/recording.h"
#include "simulation/load.h"

#include <nlohmann/json.hpp>
#include <system_error>

namespace palpa {

nlohmann::ordered_json describe_study(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    return {{"versions", {{"palpa", version_name}, {"commit", commit_name}}},
            {"scene", scene.title},
            {"scene_hash", scene_hash(scene)},
            {"hand", grip_names[static_cast<std::size_t>(scene.hand.grip)]},
            {"friction_N", scene.device.friction_N},
            {"period_ms", scene.period_ms},
            {"operators", options.operators},
            {"seed", options.seed},
            {"rest_angstrom", find_rest(scene, load_world(scene))}};
}

std::unique_ptr<FolderLock> make_study_folder(const std::filesystem::path& folder,
                                              std::initializer_list<const char*> files) {
    std::error_code error;
    for (const char* const file : files) {
        if (!std::filesystem::exists(std::filesystem::symlink_status(folder / file, error)))
            continue;
        throw LoadError({(folder / file).string()},
                        "already exists, so the folder contains a study; expected a new folder");
    }
    std::filesystem::create_directories(folder, error);
    if (error) throw LoadError({folder.string()}, "cannot be made: " + error.message());
    return std::make_unique<FolderLock>(folder);
}

}  // namespace palpa
