// The user's preferences, in a TOML file.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct Preferences {
    std::optional<std::string> device{};      // name for --device
    std::optional<bool> sound{};              // force as a tone on or off
    std::vector<std::string> recent{};        // scenes opened before, absolute paths, newest first
    std::optional<std::string> folder{};      // in which a file was looked for last
    std::vector<std::string> lessons_done{};  // names of Palpa's own, paths of others
    bool hand_explained = false;              // the signs of the hand were explained in the window
    std::optional<double> text_scale{};  // scale of the window's text, relative to the display's
    std::optional<std::array<int, 2>> window_size{};  // in the display's own units
    std::optional<bool> dark_theme{};                 // dark or light panels and background
    std::vector<std::string> panels{};                // as the window left them (app/panels.h)
    std::optional<std::string>
        language{};  // language of the window, "de"; unset: from the environment
    std::optional<std::string> download_from{};  // address before CODE.cif.gz (download/entry.h)
    std::optional<double> download_stall_seconds{};  // without data, after which a download ends

    friend bool operator==(const Preferences&, const Preferences&) = default;
};

inline constexpr std::size_t most_recent = 8;

// Puts the file in front of the list, without duplicates.
std::vector<std::string> add_recent(std::vector<std::string> recent, const std::string& file);

// Throws LoadError that names `file`, line and column.
Preferences parse_preferences(std::string_view text, const std::string& file);
std::string format_preferences(const Preferences& preferences);

// palpa/preferences.toml below XDG_CONFIG_HOME, ~/.config, or APPDATA on Windows; empty if none is
// set.
std::optional<std::filesystem::path> find_preferences_file();

// Folder for prepared structures: palpa/scenes below XDG_DATA_HOME, ~/.local/share, or APPDATA on
// Windows; empty if none is set.
std::optional<std::filesystem::path> find_prepared_folder();

// Folder for what can be had again: palpa/NAME below XDG_CACHE_HOME, ~/.cache, or LOCALAPPDATA on
// Windows; empty if none is set.
std::optional<std::filesystem::path> find_cache_folder(std::string_view name);

// Folder for what the window saves: Palpa in the user's documents, which are XDG_DOCUMENTS_DIR,
// what user-dirs.dirs says, or Documents at home if that is there; without these, home, or the
// current folder.
std::filesystem::path find_files_folder();

// The file and its content. If it cannot be read, `problem` says why; it then counts as empty and
// is never overwritten, so that its author can correct it.
class PreferencesFile {
public:
    explicit PreferencesFile(std::optional<std::filesystem::path> file);

    const Preferences& now() const noexcept { return now_; }
    const std::string& problem() const noexcept { return problem_; }

    // Whether preferences can be saved.
    bool can_keep() const noexcept { return file_ && problem_.empty(); }

    // Saves them. Throws LoadError with the reason if that fails.
    void keep(const Preferences& preferences);

private:
    std::optional<std::filesystem::path> file_;
    Preferences now_;
    std::string problem_;
};

}  // namespace palpa
