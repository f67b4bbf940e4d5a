// Writes a world as a scene, so that opening it continues where the world is.
#pragma once
#include "core/files.h"
#include "ecs/world.h"
#include "scene/description.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// A scene of the world as it is now, in `file`, and what it reads from files of the same name
// beside it: all atoms (.crd), and types and bonds (.psf) of molecules without a topology of their
// own. Settings that the world does not use come from the scene that it was loaded from. The saved
// scene is not relaxed on loading; edits that are still to come follow at the time that is left; a
// stroke "in-out", which is planned for the start of a scene, becomes "hold".
// With a remote engine, which has the coordinates, no atoms are written.
struct SavedScene {
    SceneDescription scene;
    std::vector<TextFile> files;
};
SavedScene describe_world(const World& world, const std::filesystem::path& file);

// Writes describe_world with this view; `title`: the first line of the file, without "#". Throws
// LoadError that says what cannot be written.
void save_scene(const World& world, const ViewDescription& view, const std::filesystem::path& file,
                std::string_view title, Existing existing);

// `file` and the files that save_scene may write beside it.
std::vector<std::filesystem::path> list_scene_files(const std::filesystem::path& file);

// For one session: saving again replaces its own files, never others.
class SceneSaver {
public:
    // New files are named NAME-2.toml and so on, beside the scene's file, or in `fallback` if that
    // folder cannot be written.
    SceneSaver(const std::filesystem::path& scene_file, std::filesystem::path fallback);

    // Returns the file. Throws LoadError that says why it cannot be written.
    std::filesystem::path save(const World& world, const ViewDescription& view);

private:
    std::filesystem::path folder_, fallback_;
    std::string stem_;
    std::optional<std::filesystem::path> file_;
};

}  // namespace palpa
