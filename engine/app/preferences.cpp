#include "app/preferences.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// A key, how its value is read (false: it cannot be), and the message where it cannot.
struct Preference {
    std::string_view name;
    bool (*read)(const toml::node& value, Preferences& preferences);
    std::string_view wrong;
};

template <auto Field>
bool read_text(const toml::node& value, Preferences& preferences) {
    return (preferences.*Field = value.value<std::string>()).has_value();
}

bool read_window_size(const toml::node& value, Preferences& preferences) {
    const toml::array* const sides = value.as_array();
    if (!sides || sides->size() != 2) return false;
    std::array<int, 2> size{};
    for (std::size_t i = 0; i < 2; ++i) {
        constexpr std::int64_t least = 200, most = 20'000;
        const std::optional<std::int64_t> side = sides->get(i)->value_exact<std::int64_t>();
        if (!side || *side < least || *side > most) return false;
        size[i] = static_cast<int>(*side);
    }
    preferences.window_size = size;
    return true;
}

template <auto Field>
bool read_flag(const toml::node& value, Preferences& preferences) {
    return (preferences.*Field = value.value_exact<bool>()).has_value();
}

bool read_hand_explained(const toml::node& value, Preferences& preferences) {
    const std::optional<bool> explained = value.value_exact<bool>();
    preferences.hand_explained = explained.value_or(false);
    return explained.has_value();
}

bool read_text_scale(const toml::node& value, Preferences& preferences) {
    const std::optional<double> scale = preferences.text_scale = value.value<double>();
    return scale && *scale >= 0.5 && *scale <= 4;
}

bool read_stall_seconds(const toml::node& value, Preferences& preferences) {
    const std::optional<double> time = preferences.download_stall_seconds = value.value<double>();
    return time && *time >= 1 && *time <= 3600;
}

std::optional<std::vector<std::string>> read_texts(const toml::node& value) {
    const toml::array* const several = value.as_array();
    if (!several) return {};
    std::vector<std::string> texts;
    for (const toml::node& each : *several) {
        const auto text = each.value<std::string>();
        if (!text) return {};
        texts.push_back(*text);
    }
    return texts;
}

template <auto Field>
bool read_list(const toml::node& value, Preferences& preferences) {
    const std::optional<std::vector<std::string>> texts = read_texts(value);
    preferences.*Field = texts.value_or(std::vector<std::string>());
    return texts.has_value();
}

// One scene, as versions before had it, or several.
bool read_recent(const toml::node& value, Preferences& preferences) {
    if (const auto one = value.value<std::string>()) {
        preferences.recent = add_recent(std::move(preferences.recent), *one);
        return true;
    }
    std::optional<std::vector<std::string>> recent = read_texts(value);
    if (!recent) return false;
    if (recent->size() > most_recent) recent->resize(most_recent);
    preferences.recent = std::move(*recent);
    return true;
}

constexpr std::array<Preference, 14> known_keys{
    {{"device", read_text<&Preferences::device>,
      "device is not text; expected a device name in quotes, such as \"mouse\""},
     {"sound", read_flag<&Preferences::sound>, "sound is not true or false; expected one of them"},
     {"scene", read_recent, "scene is not text; expected the file or folder of a scene, in quotes"},
     {"recent", read_recent, "recent is not a list of texts; expected scene files, [\"...\"]"},
     {"hand_explained", read_hand_explained,
      "hand_explained is not true or false; expected one of them"},
     {"text_scale", read_text_scale,
      "text_scale is not a number from 0.5 to 4 (1: the usual size)"},
     {"language", read_text<&Preferences::language>,
      "language is not text; expected a language code in quotes, such as \"de\" or \"en\""},
     {"window_size", read_window_size, "window_size is not two whole numbers from 200 to 20000"},
     {"dark_theme", read_flag<&Preferences::dark_theme>,
      "dark_theme is not true or false; expected one of them"},
     {"folder", read_text<&Preferences::folder>, "folder is not text; expected a folder in quotes"},
     {"lessons_done", read_list<&Preferences::lessons_done>,
      "lessons_done is not a list of texts, such as [\"water\"]"},
     {"panels", read_list<&Preferences::panels>,
      "panels is not a list of texts, such as [\"left 240\"]"},
     {"download_from", read_text<&Preferences::download_from>,
      "download_from is not text; expected an address in quotes that begins with https://"},
     {"download_stall_seconds", read_stall_seconds,
      "download_stall_seconds is not a number from 1 to 3600"}}};

TextPlace place_in(const std::string& file, const toml::source_region& source) {
    return {file, source.begin.line, source.begin.column};
}

[[noreturn]] void refuse_key(std::string_view key, const TextPlace& place) {
    std::array<std::string_view, known_keys.size()> names;
    std::ranges::transform(known_keys, names.begin(), &Preference::name);
    throw LoadError(place, fmt::format("unknown key '{}'; expected one of {}{}", key,
                                       fmt::join(names, ", "), near_name_hint(key, names)));
}

// The environment's folder of that name; relative ones do not count, as XDG wants it.
std::optional<fs::path> find_folder(const char* variable) {
    const char* const value = std::getenv(variable);
    if (!value || !fs::path(value).is_absolute()) return std::nullopt;
    return value;
}

}  // namespace

Preferences parse_preferences(std::string_view text, const std::string& file) {
    toml::table table;
    try {
        table = toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        throw LoadError(place_in(file, error.source()), std::string(error.description()));
    }
    Preferences preferences;
    for (const auto& [key, value] : table) {
        const TextPlace place = place_in(file, value.source());
        const auto known = std::ranges::find(known_keys, key.str(), &Preference::name);
        if (known == known_keys.end()) refuse_key(key.str(), place);
        if (!known->read(value, preferences)) throw LoadError(place, std::string(known->wrong));
    }
    return preferences;
}

std::string format_preferences(const Preferences& preferences) {
    toml::table table;
    if (preferences.device) table.insert("device", *preferences.device);
    if (preferences.window_size) {
        const auto [width, height] = *preferences.window_size;
        table.insert("window_size", toml::array{width, height});
    }
    if (preferences.dark_theme) table.insert("dark_theme", *preferences.dark_theme);
    if (preferences.sound) table.insert("sound", *preferences.sound);
    const auto insert_texts = [&](std::string_view key, const std::vector<std::string>& texts) {
        if (texts.empty()) return;
        toml::array array;
        for (const std::string& text : texts) array.push_back(text);
        table.insert(key, std::move(array));
    };
    insert_texts("recent", preferences.recent);
    if (preferences.folder) table.insert("folder", *preferences.folder);
    insert_texts("lessons_done", preferences.lessons_done);
    insert_texts("panels", preferences.panels);
    if (preferences.hand_explained) table.insert("hand_explained", true);
    if (preferences.text_scale) table.insert("text_scale", *preferences.text_scale);
    if (preferences.language) table.insert("language", *preferences.language);
    if (preferences.download_from) table.insert("download_from", *preferences.download_from);
    if (preferences.download_stall_seconds)
        table.insert("download_stall_seconds", *preferences.download_stall_seconds);
    std::ostringstream text;
    text << "# Preferences of Palpa's window.\n" << table << "\n";
    return text.str();
}

std::vector<std::string> add_recent(std::vector<std::string> recent, const std::string& file) {
    std::erase(recent, file);
    recent.insert(recent.begin(), file);
    if (recent.size() > most_recent) recent.resize(most_recent);
    return recent;
}

std::optional<fs::path> find_prepared_folder() {
    const fs::path name = fs::path("palpa") / "scenes";
    if (const auto folder = find_folder("XDG_DATA_HOME")) return *folder / name;
    if (const auto folder = find_folder("APPDATA")) return *folder / name;
    if (const auto folder = find_folder("HOME")) return *folder / ".local" / "share" / name;
    return std::nullopt;
}

std::optional<fs::path> find_cache_folder(std::string_view name) {
    const fs::path below = fs::path("palpa") / name;
    if (const auto folder = find_folder("XDG_CACHE_HOME")) return *folder / below;
    if (const auto folder = find_folder("LOCALAPPDATA")) return *folder / below;
    if (const auto folder = find_folder("HOME")) return *folder / ".cache" / below;
    return std::nullopt;
}

namespace {

// XDG_DOCUMENTS_DIR="$HOME/Texts" of user-dirs.dirs.
std::optional<fs::path> find_documents_of_desktop(const std::optional<fs::path>& home) {
    if (const auto folder = find_folder("XDG_DOCUMENTS_DIR")) return folder;
    std::optional<fs::path> config = find_folder("XDG_CONFIG_HOME");
    if (!config && home) config = *home / ".config";
    std::error_code error;
    if (!config || !fs::exists(*config / "user-dirs.dirs", error)) return {};
    try {
        const std::string text = read_text_file(*config / "user-dirs.dirs");
        for (std::string_view line : split_lines(text)) {
            constexpr std::string_view key = "XDG_DOCUMENTS_DIR=\"", at_home = "$HOME/";
            if (!line.starts_with(key) || !line.ends_with('"')) continue;
            line = line.substr(key.size(), line.size() - key.size() - 1);
            if (home && line.starts_with(at_home)) return *home / line.substr(at_home.size());
            if (fs::path(line).is_absolute()) return fs::path(line);
        }
    } catch (const LoadError&) {  // then it says nothing
    }
    return {};
}

}  // namespace

fs::path find_files_folder() {
    std::optional<fs::path> home = find_folder("HOME");
    if (!home) home = find_folder("USERPROFILE");
    std::error_code error;
    if (const auto folder = find_documents_of_desktop(home)) return *folder / "Palpa";
    if (home && fs::is_directory(*home / "Documents", error)) return *home / "Documents" / "Palpa";
    return home ? *home / "Palpa" : fs::path("Palpa");
}

std::optional<fs::path> find_preferences_file() {
    const fs::path name = fs::path("palpa") / "preferences.toml";
    if (const auto folder = find_folder("XDG_CONFIG_HOME")) return *folder / name;
    if (const auto folder = find_folder("APPDATA")) return *folder / name;
    if (const auto folder = find_folder("HOME")) return *folder / ".config" / name;
    return std::nullopt;
}

PreferencesFile::PreferencesFile(std::optional<fs::path> file) : file_(std::move(file)) {
    std::error_code error;
    if (!file_ || !fs::exists(*file_, error)) return;
    try {
        now_ = parse_preferences(read_text_file(*file_), file_->string());
    } catch (const LoadError& problem) {
        problem_ = problem.what();
    }
}

void PreferencesFile::keep(const Preferences& preferences) {
    if (preferences == now_) return;
    const TextPlace place{"preferences"};
    if (!problem_.empty()) throw LoadError(place, "preferences cannot be saved: " + problem_);
    if (!file_)
        throw LoadError(place,
                        "preferences cannot be saved: there is no settings folder (set HOME or "
                        "XDG_CONFIG_HOME)");
    make_folder(file_->parent_path());
    write_text_file(*file_, format_preferences(preferences), Existing::Replace);
    now_ = preferences;
}

}  // namespace palpa
