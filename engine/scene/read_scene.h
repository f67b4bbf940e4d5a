// Scene files: TOML, checked on reading.
#pragma once
#include "scene/description.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace palpa {

// Reads a scene folder (its scene.toml), a scene file, or one of our own scenes by name
// (scene/find_scene.h). `settings` are "key=value" as --set takes
// them, applied over the file: a key in full ("coupling.mode") or, where only one field ends in it,
// its last part ("mode"); a value in TOML, or a bare word for text. Throws LoadError with
// file:line:column, what was read and what would be right, for: a missing file, bad TOML, an
// unknown key (with the near name), a wrong type, a value out of range or not finite, a field that
// is missing, a named file that does not exist, and fields that contradict each other.
//
// A scene may come from anybody, so it may name only files below its own folder and below the
// scenes that come with the program, wherever links lead. With `allow_outside` among the settings
// any file will do.
inline constexpr std::string_view allow_outside = "--allow-outside";
SceneDescription read_scene(const std::filesystem::path& path,
                            std::span<const std::string> settings = {});

// The same of a text; file names in it are taken from `folder`.
SceneDescription parse_scene(std::string_view text, const std::filesystem::path& file,
                             std::span<const std::string> settings = {});

}  // namespace palpa
