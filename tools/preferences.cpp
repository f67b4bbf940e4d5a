#include "tools/preferences.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <array>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 4> key_names{"device", "sound", "scene", "text_scale"};
constexpr double smallest_text = 0.5, largest_text = 4;

TextPlace place_in(const std::string& file, const toml::source_region& source) {
    return {file, source.begin.line, source.begin.column};
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
        if (key == "device") {
            preferences.device = value.value<std::string>();
            if (preferences.device) continue;
            throw LoadError(place, "device is no text; expected a name as --device takes it");
        }
        if (key == "sound") {
            preferences.sound = value.value_exact<bool>();
            if (preferences.sound) continue;
            throw LoadError(place, "sound is no truth value; expected true or false");
        }
        if (key == "scene") {
            preferences.scene = value.value<std::string>();
            if (preferences.scene) continue;
            throw LoadError(place, "scene is no text; expected the file or folder of a scene");
        }
        if (key == "text_scale") {
            preferences.text_scale = value.value<double>();
            if (preferences.text_scale && *preferences.text_scale >= smallest_text &&
                *preferences.text_scale <= largest_text) {
                continue;
            }
            throw LoadError(place, fmt::format("text_scale is no number from {} to {}",
                                               smallest_text, largest_text));
        }
        throw LoadError(
            place, fmt::format("unknown key '{}'; expected one of {}{}", key.str(),
                               fmt::join(key_names, ", "), near_name_hint(key.str(), key_names)));
    }
    return preferences;
}

std::string format_preferences(const Preferences& preferences) {
    toml::table table;
    if (preferences.device) table.insert("device", *preferences.device);
    if (preferences.sound) table.insert("sound", *preferences.sound);
    if (preferences.scene) table.insert("scene", *preferences.scene);
    if (preferences.text_scale) table.insert("text_scale", *preferences.text_scale);
    std::ostringstream text;
    text << "# What was chosen in Palpa's window.\n" << table << "\n";
    return text.str();
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
    if (!problem_.empty()) throw LoadError(place, "what was chosen is not remembered: " + problem_);
    if (!file_)
        throw LoadError(place,
                        "what was chosen is not remembered: no folder for settings is named");
    std::error_code error;
    fs::create_directories(file_->parent_path(), error);
    if (error) {
        throw LoadError(place,
                        fmt::format("what was chosen is not remembered: {} cannot be made: {}",
                                    file_->parent_path().string(), error.message()));
    }
    write_text_file(*file_, format_preferences(preferences), Existing::Replace);
    now_ = preferences;
}

}  // namespace palpa
