// Reads and checks scene files (TOML).
#pragma once
#include "core/file_versions.h"
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
// The key `format` states the version of the file's format, the present one unless given. Of a
// newer minor version what is not known is left out with a note; another major version is refused.
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

// A coupling with other values for some of its keys: settings of [coupling], "mode=3", applied in
// order. Throws LoadError for what read_scene refuses of that table, with the keys that it has.
CouplingDescription with_settings(const CouplingDescription& coupling,
                                  std::span<const std::string> settings);

// A coupling of settings as list_settings writes them. Each value is checked, but not against the
// others: while sliders move, a window passes through values that no scene may have.
CouplingDescription parse_settings(std::span<const std::string> settings);

// One edit, of the text of one table [[edits]]. Files that it names are taken from the folder of
// the file that it stands in, below which they must be, as a scene's. Throws LoadError at `place`.
EditDescription parse_edit(std::string_view text, const TextPlace& place);

}  // namespace palpa
