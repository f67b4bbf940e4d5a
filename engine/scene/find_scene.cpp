#include "scene/find_scene.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/shell_word.h"
#include "core/text.h"
#include "platform/program.h"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_entries = 1000;  // of a folder that are looked at
constexpr std::size_t most_named = 20;      // in a message
constexpr const char* usual_name = "scene.toml";

// Whether a command makes its files, and has not yet.
bool is_to_be_made(const toml::table& scene, const fs::path& folder) {
    const toml::table* const molecules = scene["molecules"].as_table();
    if (!scene.contains("made_by") || !molecules) return false;
    for (const auto& [name, molecule] : *molecules) {
        const toml::table* const keys = molecule.as_table();
        if (!keys) continue;
        for (const char* const key : {"structure", "topology"}) {
            const auto file = (*keys)[key].value<std::string>();
            std::error_code error;
            if (file && !fs::exists(folder / *file, error)) return true;
        }
    }
    return false;
}

// On one line.
std::string first_sentence(const std::string& text) {
    std::string sentence;
    for (const std::string_view line : split_lines(text))
        for (const std::string_view word : split_words(line)) sentence += std::string(word) + ' ';
    for (std::size_t at = 0; (at = sentence.find(". ", at)) != std::string::npos; ++at) {
        // No abbreviation, and no number.
        if (at > 2 && sentence[at - 2] != '.' && sentence[at - 2] != ' ')
            return sentence.substr(0, at + 1);
    }
    return std::string(trimmed(sentence));
}

// Without the ending of a compressed file.
fs::path without_gz(const fs::path& file) {
    return upper_case(file.extension().string()) == ".GZ" ? file.stem() : file.filename();
}

// Nothing where it is no scene that can be read.
std::optional<SceneEntry> read_entry(const fs::path& file, const std::string& name) {
    try {
        const toml::table table = toml::parse(read_text_file(file), file.string());
        if (!table.contains("grab") && !table.contains("hand")) return std::nullopt;
        return SceneEntry{name,
                          file,
                          table["title"].value_or(std::string()),
                          first_sentence(table["about"].value_or(std::string())),
                          table["level"].value_or(std::string()),
                          table["minutes"].value_or(0.0),
                          table.contains("lesson"),
                          is_to_be_made(table, file.parent_path())};
    } catch (const toml::parse_error&) {
        return std::nullopt;
    } catch (const LoadError&) {
        return std::nullopt;
    }
}

void add_scenes_of(const fs::path& folder, const std::string& prefix,
                   std::vector<SceneEntry>& scenes) {
    for (const fs::path& path : list_folder(folder, most_entries)) {
        if (path.extension() != ".toml") continue;
        const bool is_usual = path.filename() == usual_name;
        const std::string name = is_usual ? prefix : prefix + "/" + path.stem().string();
        if (std::optional<SceneEntry> entry = read_entry(path, name))
            scenes.push_back(std::move(*entry));
    }
}

std::string join_some(const std::vector<std::string>& names) {
    const std::size_t count = std::min(names.size(), most_named);
    return fmt::format("{}{}",
                       fmt::join(names.begin(), names.begin() + static_cast<long>(count), ", "),
                       names.size() > count ? ", ..." : "");
}

std::string prepare_hint(const fs::path& structure) {
    return fmt::format("'palpa prepare {} -o {}' makes a scene from it",
                       shell_word(structure.string()),
                       shell_word(name_of_structure(structure).string()));
}

// Throws where that is known to be something else than a scene.
void refuse_other_files(const fs::path& file) {
    const std::string ending = upper_case(file.extension().string());
    if (is_structure(file)) {
        throw LoadError({file.string()}, "is a structure, not a scene; " + prepare_hint(file));
    }
    if (is_topology(file)) {
        throw LoadError(
            {file.string()},
            fmt::format("is a topology, not a scene; 'palpa prepare FILE.crd --topology "
                        "{}' makes a scene from it and its coordinates",
                        shell_word(file.string())));
    }
    if (ending == ".GZ") {
        throw LoadError({file.string()}, "is compressed, unpack it first (gunzip)");
    }
}

// What a folder without a scene of the usual name holds instead.
std::string describe_contents(const fs::path& folder) {
    std::vector<std::string> scenes, structures;
    for (const SceneEntry& scene : list_scenes(folder)) scenes.push_back(scene.file.string());
    for (const fs::path& path : list_folder(folder, most_entries)) {
        if (is_structure(path)) structures.push_back(path.string());
    }
    if (!scenes.empty()) return fmt::format("; scenes below it: {}", join_some(scenes));
    if (!structures.empty()) {
        return fmt::format("; it holds the structure {}: {}",
                           fs::path(structures[0]).filename().string(),
                           prepare_hint(structures[0]));
    }
    scenes.clear();
    std::error_code error;
    const fs::path parent = fs::absolute(folder, error).lexically_normal().parent_path();
    for (const SceneEntry& scene : list_scenes(parent)) scenes.push_back(scene.file.string());
    return scenes.empty() ? std::string() : fmt::format("; scenes near it: {}", join_some(scenes));
}

// The name of one of Palpa's own scenes, for one written as a path in the source tree.
std::string own_scene_name(const fs::path& named) {
    std::string name = named.lexically_normal().generic_string();
    if (name.starts_with("scenes/")) name.erase(0, 7);
    if (name.ends_with(".toml")) name.resize(name.size() - 5);
    if (name.ends_with("/scene")) name.resize(name.size() - 6);
    while (name.ends_with('/')) name.pop_back();
    return name;
}

std::optional<fs::path> find_own_scene(const fs::path& named) {
    const std::string name = own_scene_name(named);
    for (const fs::path& folder : own_scene_folders()) {
        for (const SceneEntry& scene : list_scenes(folder)) {
            if (scene.name == name) return scene.file;
        }
    }
    return std::nullopt;
}

std::string describe_own_scenes(const fs::path& named) {
    std::vector<std::string> names;
    for (const fs::path& folder : own_scene_folders()) {
        for (const SceneEntry& scene : list_scenes(folder)) names.push_back(scene.name);
    }
    if (names.empty()) return {};
    // Of many not all are named: what a folder shows first goes before its variants.
    std::ranges::stable_partition(
        names, [](const std::string& name) { return name.find('/') == std::string::npos; });
    const std::vector<std::string_view> views(names.begin(), names.end());
    const std::string wanted = own_scene_name(named);
    std::vector<std::string> of_it;
    std::ranges::copy_if(names, std::back_inserter(of_it),
                         [&](const std::string& name) { return name.starts_with(wanted + "/"); });
    if (!of_it.empty()) return fmt::format("; did you mean {}?", fmt::join(of_it, " or "));
    const std::string hint = near_name_hint(wanted, views);
    return hint.empty() ? fmt::format("; Palpa's own scenes: {}", join_some(names)) : hint;
}

}  // namespace

std::string describe_effort(const SceneEntry& scene) {
    std::vector<std::string> parts;
    if (scene.has_lesson) parts.emplace_back("lesson");
    if (!scene.level.empty()) parts.push_back(scene.level);
    if (scene.minutes > 0) parts.push_back(fmt::format("{:.0f} minutes", scene.minutes));
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<fs::path> own_scene_folders() {
    const fs::path program = find_program_file().parent_path();
    if (program.empty()) return {};
    std::vector<fs::path> folders{(program / PALPA_SHARE / "scenes").lexically_normal()};
    const fs::path builds = program.parent_path().parent_path();  // build/PRESET/bin
    if (builds.filename() == "build") folders.push_back(builds.parent_path() / "scenes");
    std::erase_if(folders, [](const fs::path& folder) {
        std::error_code error;
        return !fs::is_directory(folder, error);
    });
    return folders;
}

bool is_structure(const fs::path& file) {
    constexpr std::array<std::string_view, 6> endings{".PDB",   ".ENT", ".CIF",
                                                      ".MMCIF", ".CRD", ".COR"};
    const std::string ending = upper_case(without_gz(file).extension().string());
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

fs::path name_of_structure(const fs::path& file) { return without_gz(file).stem(); }

bool is_topology(const fs::path& file) { return upper_case(file.extension().string()) == ".PSF"; }

bool is_journal(const fs::path& file) { return without_gz(file) == journal_name; }

bool can_be_opened(const fs::path& file) {
    return is_structure(file) || is_topology(file) || is_journal(file) ||
           upper_case(file.extension().string()) == ".TOML";
}

std::vector<std::string> list_endings() {
    return {".pdb",   ".ent",  ".cif",
            ".mmcif", ".crd",  ".cor",
            ".psf",   ".toml", std::string(journal_name)};
}

std::vector<SceneEntry> list_scenes(const fs::path& folder) {
    std::vector<SceneEntry> scenes;
    for (const fs::path& path : list_folder(folder, most_entries)) {
        std::error_code error;
        if (fs::is_directory(path, error)) add_scenes_of(path, path.filename().string(), scenes);
    }
    add_scenes_of(folder, ".", scenes);
    std::sort(scenes.begin(), scenes.end(),
              [](const SceneEntry& a, const SceneEntry& b) { return a.name < b.name; });
    return scenes;
}

SceneEntry describe_file(const fs::path& file) {
    SceneEntry entry{file.string(), file};
    if (file.extension() == ".toml")
        if (std::optional<SceneEntry> read = read_entry(file, file.string()))
            entry = std::move(*read);
    if (entry.title.empty())
        entry.title = (file.parent_path().filename() / file.filename()).generic_string();
    return entry;
}

fs::path find_scene_file(const fs::path& named) {
    std::error_code error;
    if (fs::is_directory(named, error)) {
        const fs::path file = named / usual_name;
        if (fs::exists(file, error)) return file;
        if (error && error != std::errc::no_such_file_or_directory)
            throw LoadError({file.string()}, "cannot be read: " + error.message());
        std::string contents = describe_contents(named);
        const std::optional<fs::path> own = find_own_scene(named);
        if (own) {
            contents += fmt::format("; Palpa's own scene of that name: {}", own->string());
        } else if (contents.empty()) {
            contents = describe_own_scenes({});
        }
        throw LoadError({named.string()},
                        "this folder has no scene.toml, so it is not a scene" + contents);
    }
    if (fs::exists(named, error)) {
        refuse_other_files(named);
        return named;
    }
    if (auto own = find_own_scene(named)) return *own;
    throw LoadError({named.string()},
                    "no such scene; expected a scene folder, a .toml file or the "
                    "name of a scene" +
                        describe_own_scenes(named));
}

}  // namespace palpa
