// A scene as it was set in the window, as a scene file of its own.
#pragma once
#include "scene/description.h"

#include <filesystem>
#include <optional>

namespace palpa {

// Of one session: saved again, its file is replaced. Other files never are.
class SceneSaver {
public:
    // New files are called NAME-2.toml and on, beside the scene's own file, or in `fallback` where
    // that folder cannot be written.
    SceneSaver(const std::filesystem::path& scene_file, std::filesystem::path fallback);

    // Returns the file. Throws LoadError that says why it cannot be written.
    std::filesystem::path save(const SceneDescription& scene);

private:
    std::filesystem::path folder_, fallback_;
    std::string stem_;
    std::optional<std::filesystem::path> file_;
};

}  // namespace palpa
