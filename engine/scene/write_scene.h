// Writes a scene as TOML, with every field.
#pragma once
#include "scene/description.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Reading the text gives the same description to the last bit. `file_name` says what a file of the
// scene is to be called in it, relative to where the text will stand.
std::string format_scene(const SceneDescription& scene,
                         const std::function<std::string(const std::filesystem::path&)>& file_name);

// One edit as the table [[edits]] of a scene file; read_scene.h's parse_edit reads it.
std::string format_edit(const EditDescription& edit);

// A coupling as settings "key = value", every one of them; read_scene.h's
// parse_settings reads them.
std::vector<std::string> list_settings(const CouplingDescription& coupling);

// As text of a scene file, in quotes, with what TOML does not take as it is written as \uXXXX.
// `text` must be UTF-8.
std::string in_quotes(std::string_view text);

}  // namespace palpa
