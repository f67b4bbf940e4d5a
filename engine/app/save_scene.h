// Saves a scene with the settings of the window as a new scene file.
#pragma once
#include "scene/description.h"

#include <filesystem>
#include <optional>

namespace palpa {

// For one session: saving again replaces its own file, never another one.
class SceneSaver {
public:
    // New files are named NAME-2.toml and so on, beside the scene's file, or in `fallback` if that
    // folder cannot be written.
    SceneSaver(const std::filesystem::path& scene_file, std::filesystem::path fallback);

    // Returns the file. Throws LoadError that says why it cannot be written.
    std::filesystem::path save(const SceneDescription& scene);

private:
    std::filesystem::path folder_, fallback_;
    std::string stem_;
    std::optional<std::filesystem::path> file_;
};

}  // namespace palpa
