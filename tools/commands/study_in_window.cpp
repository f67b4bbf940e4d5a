// palpa study: a person takes part, in a window. Adds their trials to the folder's table, each as
// soon as it is done; session.json beside it has the settings.
#include "app/run_window.h"
#include "app/window_shell.h"
#include "core/files.h"
#include "core/load_error.h"
#include "devices/emulated_hand.h"
#include "devices/emulated_omni.h"
#include "experiments/study.h"
#include "experiments/study_course.h"
#include "experiments/study_scene.h"
#include "haptics/hand.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "tools/commands/command.h"
#include "tools/commands/study.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <vector>

namespace palpa {
namespace {

// With everybody's trials so far.
std::string read_table(const std::filesystem::path& table) {
    std::string text = read_text_file(table);
    if (!text.starts_with(trial_names())) {
        throw LoadError({table.string(), 1}, "is not a table of a study; expected another folder");
    }
    return text;
}

// What everybody's trials in a folder have in common. Keys that tell most stand first.
nlohmann::ordered_json describe_people(const StudyOptions& options) {
    const nlohmann::ordered_json study = describe_study(options);
    nlohmann::ordered_json json{{"seed", options.seed}, {"rounds", options.rounds}};
    for (const CouplingMode mode : options.modes)
        json["modes"].push_back(coupling_mode_names[static_cast<std::size_t>(mode)]);
    for (const char* const key : {"hand", "friction_N", "period_ms", "scene", "rest_angstrom"})
        json[key] = study[key];
    json["settings"] = options.settings;
    json["scene_hash"] = study["scene_hash"];
    json["versions"] = study["versions"];
    return json;
}

// One table is of one study. Throws LoadError that says what differs.
void check_same_study(const std::filesystem::path& file, const nlohmann::ordered_json& now) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        throw LoadError({file.string()},
                        "is missing, so the settings of the trials beside it are unknown; expected "
                        "another folder");
    }
    const auto before = nlohmann::json::parse(read_text_file(file), nullptr, false);
    if (!before.is_object())
        throw LoadError({file.string()},
                        "does not contain the settings of a study; expected another folder");
    const auto was = [&](const std::string& key) { return before.value(key, nlohmann::json()); };
    for (const auto& [key, value] : now.items()) {
        // Settings may be the scene's own.
        if (key == "settings" && was("scene_hash") == now["scene_hash"]) continue;
        if (was(key) == nlohmann::json(value)) continue;
        throw LoadError({file.string()},
                        fmt::format("the trials in this folder have {} = {}, but these would have "
                                    "{}; expected the same settings, or another folder",
                                    key, was(key).dump(), value.dump()));
    }
}

// Six digits by the system's chance, nothing of the person.
std::size_t draw_participant() {
    std::random_device chance;
    return 100'000 + chance() % 900'000;
}

struct StudyCommand : StudyOptions {
    std::optional<std::filesystem::path> folder;
    bool validation = false;
};

// Also throws LoadError without a folder or where its trials have other settings, PlatformError
// without a display.
int run_study(const StudyCommand& command) {
    const StudyOptions& options = command;
    check_study(options);
    if (!command.folder) {
        throw LoadError({"--output"}, "is missing; expected the folder with the trials of people");
    }
    make_folder(*command.folder);
    const FolderLock lock(*command.folder);  // a second window would lose the first one's trials
    const std::filesystem::path table = *command.folder / "trials.csv";
    const std::filesystem::path line = *command.folder / "line.csv";
    const std::filesystem::path session = *command.folder / "session.json";
    const nlohmann::ordered_json study = describe_people(options);
    std::error_code error;
    const bool is_first = !std::filesystem::exists(table, error);
    const Existing line_existing = check_output(line, line_names, true);
    const std::string before = is_first ? trial_names() : read_table(table);
    if (is_first) {
        (void)check_output(session, {}, false);
    } else {
        check_same_study(session, study);
    }

    const double rest = find_rest(options);
    const SceneDescription scene = read_study_scene(
        options, {"hand.stroke=hold",
                  fmt::format("hand.start_angstrom={}", rest + StudyCourse::practice_angstrom)});
    const World world = load_world(scene);
    const std::size_t participant = draw_participant();
    StudyCourse course(plan_study(participant, options.rounds, options.modes, options.seed),
                       CouplingMode::Guarded, {rest, find_wall(world, grabbed_distance(world))},
                       options.seed);
    HandOrders orders;
    EmulatedOmniSettings omni = build_study_device(scene, {});
    omni.orders = &orders;
    give_to_mouse(omni);
    EmulatedOmni device(omni);
    ViewSettings view = first_settings(scene.view, world);
    // They would show what is to be felt.
    view.force_arrow = false;
    view.hydrogen_bonds = ShownBonds::None;
    view.marks = {};
    WindowOptions window;
    window.view = view;
    window.orders = &orders;
    window.mouse_reach_m = mouse_reach_m(omni);
    window.study = &course;
    window.on_trial = [&] {
        if (is_first) write_text_file(session, study.dump(2) + "\n", Existing::Replace);
        write_text_file(table, before + format_trials(course.results()), Existing::Replace);
    };
    ShellOptions shell_options;
    shell_options.validation = command.validation;
    WindowShell shell(shell_options);
    (void)run_window(shell, scene, device, window);

    if (course.results().empty()) return 0;
    write_text_file(line, format_line(options), line_existing);
    fmt::print("participant {}: {} of {} trials, in {}\n{}", participant, course.results().size(),
               options.rounds * options.modes.size(), table.string(),
               format_study_table(summarise_study(options.modes, course.results())));
    return 0;
}

}  // namespace

void add_study(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& study = *program.add_subcommand(
        "study", "Take part in the paper's experiment: find the place without force");
    StudyCommand& command = own_options<StudyCommand>(study, chosen, run_study);
    describe(study, {"palpa study scenes/water -o people"}, "Emulated operators: palpa-lab study.");
    add_rounds_option(study, command);
    add_study_options(study, command);
    study.add_option("-o,--output", command.folder,
                     "folder for the trials, to which each person adds: trials.csv, session.json "
                     "and line.csv (required)");
    study.add_flag("--validation", command.validation,
                   "check the window's drawing by the Vulkan validation layer");
}

}  // namespace palpa
