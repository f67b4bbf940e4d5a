#include "tools/commands/start.h"

#include "app/fetch_structure.h"
#include "app/preferences.h"
#include "app/start_screen.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "download/pdb_code.h"
#include "platform/system.h"
#include "scene/find_scene.h"
#include "tools/commands/command.h"
#include "tools/commands/screens.h"
#include "window/window.h"

#include <fmt/format.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

void print_scenes(const std::vector<std::string>& recent) {
    fmt::print("Scenes\n");
    for (const fs::path& folder : own_scene_folders()) {
        for (const SceneEntry& scene : list_scenes(folder)) {
            const std::string effort = describe_effort(scene);
            fmt::print("  {:<16} {}{}{}\n", printable(scene.name), printable(scene.title),
                       effort.empty() ? "" : fmt::format(" ({})", effort),
                       scene.is_to_be_made ? " (made on demand)" : "");
        }
    }
    for (const std::string& file : recent) {
        std::error_code error;
        if (fs::exists(file, error)) fmt::print("  opened before    {}\n", printable(file));
    }
    fmt::print(
        "\n  palpa run water                open a scene in a window\n  palpa run water --headless "
        "    play it without a display\n  palpa prepare 1abc.pdb ...     make a scene of your own "
        "molecule\n  palpa 1abc.pdb                 prepare it and open it in a window\n  palpa "
        "1hsg                     download this PDB entry first\n  palpa "
        "devices                  check which devices are found, and what is missing\n  palpa "
        "--help                   list all commands\n");
}

}  // namespace

int start_command() {
    const std::vector<std::string> recent = PreferencesFile(find_preferences_file()).now().recent;
    if (has_display()) {
        try {
            return open_screens({});
        } catch (const PlatformError&) {
            print_scenes(recent);
            throw;
        }
    }
    print_scenes(recent);
    return 0;
}

bool is_file_to_open(const std::string& argument) {
    return can_be_opened(argument) || find_pdb_code(argument);
}

int open_command(const std::vector<std::string>& files) {
    const NextScreen named = name_screen({files.begin(), files.end()});
    for (const fs::path& path : named.files) {
        const std::string file = path.string();
        if (file.starts_with('-'))
            throw LoadError({file},
                            "is an option, which 'palpa FILE' does not take; use 'palpa run SCENE' "
                            "with options");
        std::error_code error;
        if (!fs::is_directory(path, error) && !std::ifstream(path))
            throw LoadError({file}, "cannot be read; check that the file exists");
        note_file_before_code(file);
    }
    if (!has_display()) {
        throw LoadError({files[0]},
                        "needs a display; without one, make a scene with 'palpa prepare FILE -o "
                        "FOLDER' and play it with 'palpa run SCENE --headless'");
    }
    return open_screens(named);
}

}  // namespace palpa
