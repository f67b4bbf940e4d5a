#include "tools/commands/start.h"

#include "app/preferences.h"
#include "core/load_error.h"
#include "core/text.h"
#include "platform/display.h"
#include "platform/terminal.h"
#include "scene/find_scene.h"
#include "tools/commands/run.h"

#include <fmt/format.h>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

void print_scenes(const std::optional<std::string>& last) {
    fmt::print("Scenes\n");
    for (const fs::path& folder : own_scene_folders()) {
        for (const SceneEntry& scene : list_scenes(folder)) {
            fmt::print("  {:<16} {}{}\n", printable(scene.name), printable(scene.title),
                       scene.is_to_be_made ? " (made on demand)" : "");
        }
    }
    std::error_code error;
    if (last && fs::exists(*last, error)) fmt::print("  last time        {}\n", printable(*last));
    fmt::print(
        "\n"
        "  palpa run water                opens one in a window\n"
        "  palpa run water --headless     plays it without a display\n"
        "  palpa prepare 1abc.pdb ...     makes one of your own molecule\n"
        "  palpa --help                   lists all commands\n");
}

// A double click has no terminal to read a list in.
std::optional<fs::path> find_scene_to_open(const std::optional<std::string>& last) {
    std::error_code error;
    if (!has_display()) return std::nullopt;
    if (last && fs::exists(*last, error)) return *last;
    if (is_terminal(stdout)) return std::nullopt;
    for (const fs::path& folder : own_scene_folders()) {
        if (fs::exists(folder / "water", error)) return folder / "water";
    }
    return std::nullopt;
}

}  // namespace

int start_command() {
    const std::optional<std::string> last = PreferencesFile(find_preferences_file()).now().scene;
    if (const std::optional<fs::path> scene = find_scene_to_open(last)) {
        RunOptions options;
        options.scene = *scene;
        try {
            return run_command(options);
        } catch (const LoadError&) {  // whoever cannot open that one may want another
            print_scenes({});
            throw;
        }
    }
    print_scenes(last);
    return 0;
}

}  // namespace palpa
