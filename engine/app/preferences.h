// What the program remembers of a person's choices, in a file of theirs: TOML, a few keys.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct Preferences {
    std::optional<std::string> device{};    // as --device takes it
    std::optional<bool> sound{};            // the felt force as a tone
    std::vector<std::string> recent{};      // scenes that were opened, absolute, the newest first
    std::optional<double> text_scale{};     // of the window's text, over the display's own
    std::optional<std::string> language{};  // of the window, "de"; else as the environment says

    friend bool operator==(const Preferences&, const Preferences&) = default;
};

inline constexpr std::size_t most_recent = 8;

// The file in front of those opened before, once.
std::vector<std::string> add_recent(std::vector<std::string> recent, const std::string& file);

// Throws LoadError that names `file`, line and column.
Preferences parse_preferences(std::string_view text, const std::string& file);
std::string format_preferences(const Preferences& preferences);

// palpa/preferences.toml below XDG_CONFIG_HOME, or ~/.config, or APPDATA on Windows; nothing where
// none of them is set.
std::optional<std::filesystem::path> find_preferences_file();

// Where structures that were opened are prepared: palpa/scenes below XDG_DATA_HOME, or
// ~/.local/share, or APPDATA on Windows; nothing where none of them is set.
std::optional<std::filesystem::path> find_prepared_folder();

// The file and what is in it. One that cannot be read is said in `problem`, counts as empty, and is
// never written over: whoever wrote it can mend it.
class PreferencesFile {
public:
    explicit PreferencesFile(std::optional<std::filesystem::path> file);

    const Preferences& now() const noexcept { return now_; }
    const std::string& problem() const noexcept { return problem_; }

    // Whether there is a place for them.
    bool can_keep() const noexcept { return file_ && problem_.empty(); }

    // Keeps them on disk. Throws LoadError that says why it cannot.
    void keep(const Preferences& preferences);

private:
    std::optional<std::filesystem::path> file_;
    Preferences now_;
    std::string problem_;
};

}  // namespace palpa
