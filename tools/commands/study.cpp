#include "tools/commands/study.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/version.h"
#include "loading/load.h"
#include "session/recording.h"
#include "tools/commands/choice.h"
#include "tools/commands/command.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

namespace palpa {
namespace {

// "1,2,guarded" as modes, each once. Throws LoadError.
std::vector<CouplingMode> modes_called(const std::string& names) {
    std::vector<CouplingMode> modes;
    for (std::size_t begin = 0; begin <= names.size();) {
        const std::size_t end = std::min(names.find(',', begin), names.size());
        const std::string name(trimmed(names.substr(begin, end - begin)));
        const auto mode =
            static_cast<CouplingMode>(choice_called("--modes", name, coupling_mode_names));
        if (std::ranges::find(modes, mode) != modes.end()) {
            throw LoadError({"--modes " + names},
                            fmt::format("names {} twice; expected each mode once", name));
        }
        modes.push_back(mode);
        begin = end + 1;
    }
    return modes;
}

}  // namespace

void add_study_options(CLI::App& command, StudyOptions& options) {
    command.add_option("scene", options.scene, "scene folder or file of one axis")->required();
    command.add_option_function<std::string>(
        "--modes", [&options](const std::string& names) { options.modes = modes_called(names); },
        "modes 1 to 5 and guarded, separated by commas (default: all)");
    add_seed_option(command, options.seed);
    add_setting(command, "--period-ms", "declared period of the simulation, ms (default 14)",
                options.settings);
    add_setting(command, "--hand",
                "model of the hand at the handle: light, slack, medium, firm or firm-grip",
                options.settings);
    add_setting(command, "--friction", "Coulomb friction of the device", options.settings);
    add_set_option(command, options.settings);
}

CLI::Option* add_rounds_option(CLI::App& command, StudyOptions& options) {
    return command
        .add_option("--rounds", options.rounds,
                    "number of rounds, each with every mode once (default 3)")
        ->check(in_range(1, 999));
}

nlohmann::ordered_json describe_study(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    return {{"versions", {{"palpa", version_name}, {"commit", commit_name}}},
            {"scene", scene.title},
            {"scene_hash", scene_hash(scene)},
            {"hand", grip_names[static_cast<std::size_t>(scene.hands.front().grip)]},
            {"friction_N", device_of(scene, 0).friction_N},
            {"period_ms", scene.period_ms},
            {"seed", options.seed},
            {"rest_angstrom", find_rest(scene, load_world(scene))}};
}

std::unique_ptr<FolderLock> make_study_folder(const std::filesystem::path& folder,
                                              std::initializer_list<const char*> files) {
    std::error_code error;
    for (const char* const file : files) {
        if (!std::filesystem::exists(std::filesystem::symlink_status(folder / file, error)))
            continue;
        throw LoadError({(folder / file).string()},
                        "already exists, so the folder contains a study; expected a new folder");
    }
    make_folder(folder);
    return std::make_unique<FolderLock>(folder);
}

}  // namespace palpa
