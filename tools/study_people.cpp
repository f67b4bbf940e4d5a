#include "tools/study_people.h"

#include "app/run_window.h"
#include "core/files.h"
#include "core/load_error.h"
#include "devices/emulated_omni.h"
#include "haptics/hand.h"
#include "session/study_course.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "tools/run.h"
#include "view/build_frame.h"

#include <fmt/format.h>
#include <filesystem>
#include <random>
#include <string>
#include <system_error>
#include <vector>

namespace palpa {
namespace {

// Every trial begins so far outside of the place to be found.
constexpr double start_angstrom = 5;

// With everybody's trials so far, or its names alone.
std::string read_table(const std::filesystem::path& table) {
    std::error_code error;
    if (!std::filesystem::exists(table, error)) return trial_names();
    std::string text = read_text_file(table);
    if (!text.starts_with(trial_names())) {
        throw LoadError({table.string(), 1}, "is no table of a study; expected another folder");
    }
    return text;
}

// Six digits by the system's chance, nothing of the person.
std::size_t draw_participant() {
    std::random_device chance;
    return 100'000 + chance() % 900'000;
}

}  // namespace

int study_in_window(const StudyOptions& options) {
    if (!options.folder) {
        throw LoadError({"--output"},
                        "is missing; expected the folder in which people's trials are kept");
    }
    std::error_code error;
    std::filesystem::create_directories(*options.folder, error);
    if (error) throw LoadError({options.folder->string()}, "cannot be made: " + error.message());
    const std::filesystem::path table = *options.folder / "trials.csv";
    const std::string before = read_table(table);

    const double rest = find_rest(options);
    const SceneDescription scene = read_study_scene(
        options,
        {"hand.stroke=hold", fmt::format("hand.start_angstrom={}", rest + start_angstrom)});
    const Simulation simulation = load_simulation(scene);
    const std::size_t participant = draw_participant();
    StudyCourse course(plan_study(participant, options.rounds, options.modes, options.seed),
                       CouplingMode::Guarded,
                       {rest, find_wall(simulation, grabbed_distance(simulation))});
    HandOrders orders;
    EmulatedOmniSettings omni = build_study_device(scene, {});
    omni.orders = &orders;
    give_to_mouse(omni);
    EmulatedOmni device(omni);
    ViewSettings view = default_view(simulation);
    view.force_arrow = false;  // it would show what is to be felt
    WindowOptions window;
    window.view = view;
    window.orders = &orders;
    window.mouse_reach_m = mouse_reach_m(omni);
    window.study = &course;
    window.on_trial = [&] { write_text_file(table, before + format_trials(course.results())); };
    window.validation = options.validation;
    (void)run_window(scene, device, window);

    if (course.results().empty()) return 0;
    write_text_file(*options.folder / "line.csv", format_line(options));
    fmt::print("participant {}: {} of {} trials, in {}\n{}", participant, course.results().size(),
               options.rounds * options.modes.size(), table.string(),
               format_study_table(summarise_study(options.modes, course.results())));
    return 0;
}

}  // namespace palpa
