// Finds scenes by folder, file, or the name of a built-in one.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct SceneEntry {
    std::string name;  // relative to the folder of the list: "hiv", "hiv/flexible"
    std::filesystem::path file;
    std::string title{};  // title of the file; may be empty
    std::string about{};  // its first sentence
    std::string level{};  // empty: not stated
    double minutes = 0;   // duration, min; 0: not stated
    bool has_lesson = false;
    bool is_to_be_made =
        false;  // by a command that the file names: its molecules are not there yet
};

// Whom it is for and how long it takes: "lesson, beginner, 10 minutes"; empty where nothing is
// stated.
std::string describe_effort(const SceneEntry& scene);

// Where the scenes are that come with the program: installed beside it, or in the source tree of a
// build. Those that exist.
std::vector<std::filesystem::path> own_scene_folders();

// The scene files in a folder and in the folders directly below, by name. What cannot be read is
// left out.
std::vector<SceneEntry> list_scenes(const std::filesystem::path& folder);

// A scene file as an entry, whose name is its path; its title is the name of its folder where it
// has none, or is no scene: a structure, a recorded session.
SceneEntry describe_file(const std::filesystem::path& file);

// Whether the file's ending is that of a structure: .pdb, .cif, .crd and others, also with .gz.
bool is_structure(const std::filesystem::path& file);

// The file's name without its endings: "1hsg" of "1hsg.cif.gz".
std::filesystem::path name_of_structure(const std::filesystem::path& file);

// Whether it is a topology (.psf), which is opened with its coordinates.
bool is_topology(const std::filesystem::path& file);

// The journal of a recorded session of a window, in its folder; compressed it is journal.txt.gz.
inline constexpr std::string_view journal_name = "journal.txt";
bool is_journal(const std::filesystem::path& file);

// Whether a file of this name can be opened: a scene (.toml), a structure, a topology, or the
// journal of a recorded session; and the endings of such files, in lower case, without .gz.
bool can_be_opened(const std::filesystem::path& file);
std::vector<std::string> list_endings();

// The scene file that is meant by a folder, a file or the name of one of our own scenes. Throws
// LoadError where there is none, with what is near: other scenes, or the command that makes a scene
// of a structure.
std::filesystem::path find_scene_file(const std::filesystem::path& named);

}  // namespace palpa
