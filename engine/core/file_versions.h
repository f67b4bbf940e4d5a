// Versions of the files that Palpa writes and reads again. A new major number: names or lines
// changed their meaning, and older programs refuse the file. A new minor one: something was added,
// which older programs leave out.
#pragma once
#include "core/load_error.h"

#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

struct FileVersion {
    int major = 0, minor = 0;
    friend auto operator<=>(const FileVersion&, const FileVersion&) = default;
};

// The versions that this program writes; it reads those of the same major number.
// Scene: scene.toml, its key `format`, of this version where it is not given. Recording: columns of
// trace.csv and keys of summary.json, the number is in session.toml. Journal: journal.txt.
inline constexpr FileVersion scene_version{2, 2}, recording_version{2, 1}, journal_version{2, 2};

// "2.0".
std::string to_string(FileVersion version);

// Of "2.0" or "2"; nothing else is one.
std::optional<FileVersion> find_version(std::string_view text);

// "scene 2.2, recording 2.1, journal 2.2".
std::string list_file_versions();

// Throws LoadError for a version of another major number.
// Returns a note for one of a newer minor number, which ends with `of_unknown`, else nothing.
// `kind`: "scene", "journal".
std::optional<std::string> check_version(
    std::string_view kind, FileVersion stated, FileVersion ours, const TextPlace& place,
    std::string_view of_unknown = "what it does not know is left out");

}  // namespace palpa
