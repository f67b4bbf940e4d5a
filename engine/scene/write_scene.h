// A scene as TOML again, every field written out.
#pragma once
#include "scene/description.h"

#include <filesystem>
#include <functional>
#include <string>

namespace palpa {

// Reading the text gives the same description to the last bit. `file_name` says what a file of the
// scene is to be called in it, relative to where the text will stand.
std::string format_scene(const SceneDescription& scene,
                         const std::function<std::string(const std::filesystem::path&)>& file_name);

}  // namespace palpa
