#include "tools/study.h"

#include "core/draws.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "core/version.h"
#include "devices/emulated_omni.h"
#include "haptics/hand.h"
#include "scene/read_scene.h"
#include "session/lockstep.h"
#include "session/recording.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "simulation/step.h"
#include "tools/choice.h"
#include "tools/study_people.h"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

namespace palpa {
namespace {

constexpr double nN = units::newton_per_kcal_per_mol_angstrom * 1e9;

// Forces beyond feel the same whatever they are, so a hand that got there went through the wall.
constexpr double through_nN = 100;

// Who it is, by the participant's draws, and what this trial begins with, by its own.
OperatorSettings draw_operator(const StudyOptions& options, const StudyTrial& trial,
                               const SceneDescription& scene, double rest, Draws& draws) {
    Draws person(options.seed, participant_number(trial.participant));
    OperatorSettings settings;
    settings.manner = options.manner;
    settings.threshold_newton = person.between(0.05, 0.1);
    settings.approach_m_per_s = person.between(0.03, 0.06);
    settings.has_force = trial.mode != CouplingMode::NoForce;
    settings.handle_m_per_angstrom = scene.coupling.A_d * units::metre_per_angstrom;
    // Where contact begins is seen well enough. To find the rest by the picture alone is guessing:
    // this spread is of the size that people had in the paper, and goes no nearer than molecules
    // visibly are in each other.
    settings.guess_angstrom = settings.has_force
                                  ? rest + std::abs(0.3 * draws.normal())
                                  : std::max(rest - 0.47, rest + 0.35 + 1.2 * draws.normal());
    return settings;
}

nlohmann::ordered_json as_json(const Spread& spread) {
    nlohmann::ordered_json json{
        {"mean", spread.mean}, {"median", spread.median}, {"deviation", nullptr}};
    if (spread.deviation) json["deviation"] = *spread.deviation;
    return json;
}

std::string format_study_json(const StudyOptions& options, const std::vector<StudyRow>& rows) {
    nlohmann::ordered_json json = describe_study(options);
    json["operator"] = operator_manner_names[static_cast<std::size_t>(options.manner)];
    json["rounds"] = options.rounds;
    json["limit_s"] = options.limit_s;
    for (const StudyRow& row : rows) {
        json["modes"].push_back({{"mode", coupling_mode_names[static_cast<std::size_t>(row.mode)]},
                                 {"trials", row.trials},
                                 {"distance_angstrom", as_json(row.distance_angstrom)},
                                 {"off_angstrom", as_json(row.off_angstrom)},
                                 {"time_s", as_json(row.time_s)},
                                 {"finished_share", row.finished_share},
                                 {"through_share", row.through_share}});
    }
    return json.dump(2) + "\n";
}

}  // namespace

SceneDescription read_study_scene(const StudyOptions& options,
                                  const std::vector<std::string>& trial_settings) {
    std::vector<std::string> settings{fmt::format("run.period_ms={}", study_period_ms)};
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    settings.insert(settings.end(), trial_settings.begin(), trial_settings.end());
    return read_scene(options.scene, settings);
}

double find_rest(const SceneDescription& scene, const Simulation& simulation) {
    if (moves_in_space(simulation) || simulation.flexible) {
        throw LoadError(scene.place_of("grab.molecule"),
                        "is to be found at one place on a line; expected a molecule that moves "
                        "along-x, and others that do not move by themselves");
    }
    const std::optional<double> rest = equilibrium_distance(simulation);
    if (!rest) {
        throw LoadError(scene.place_of("grab.molecule"),
                        "is nowhere drawn back and forth to one place on its line; expected "
                        "molecules that attract each other");
    }
    return *rest;
}

double find_wall(const Simulation& simulation, double outermost) {
    return repulsion_distance(simulation, through_nN / nN, outermost).value_or(0);
}

double find_rest(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    return find_rest(scene, load_simulation(scene));
}

std::string format_line(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    const Simulation simulation = load_simulation(scene);
    const double rest = find_rest(scene, simulation);
    std::string text(line_names);
    for (int i = -100; i <= 700; ++i) {
        const double distance = rest + 0.01 * i;
        const double force = force_along_line_at(simulation, distance).force * nN;
        if (force < 3) text += fmt::format("{:.4f},{:.6f}\n", distance, force);
    }
    return text;
}

void check_study(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    if (!hand_model(static_cast<Grip>(scene.hand.grip))) {
        throw LoadError(scene.place_of("hand.grip"),
                        "is none, and no hand finds nothing; expected one that holds the handle");
    }
    (void)find_rest(scene, load_simulation(scene));
}

EmulatedOmniSettings build_study_device(const SceneDescription& scene, const HandScript& script) {
    return {
        .dynamics = {scene.device.inertia_kg, scene.device.viscosity_N_s_per_m},
        .friction_newton = scene.device.friction_N,
        .encoder_step_m = scene.device.encoder_step_mm * 1e-3,
        .hand = hand_model(static_cast<Grip>(scene.hand.grip)),
        .script = script,
        .half_workspace_m = Vec3::Constant(0.5),
    };
}

nlohmann::ordered_json describe_study(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    return {{"versions", {{"palpa", version_name}, {"commit", commit_name}}},
            {"scene", scene.title},
            {"scene_hash", scene_hash(scene)},
            {"hand", hand_names[scene.hand.grip]},
            {"friction_N", scene.device.friction_N},
            {"period_ms", scene.period_ms},
            {"operators", options.operators},
            {"seed", options.seed},
            {"rest_angstrom", find_rest(scene, load_simulation(scene))}};
}

std::unique_ptr<FolderLock> make_study_folder(const std::filesystem::path& folder,
                                              std::initializer_list<const char*> files) {
    std::error_code error;
    for (const char* const file : files) {
        if (!std::filesystem::exists(std::filesystem::symlink_status(folder / file, error)))
            continue;
        throw LoadError({(folder / file).string()},
                        "is there, so the folder holds a study already; expected a new folder");
    }
    std::filesystem::create_directories(folder, error);
    if (error) throw LoadError({folder.string()}, "cannot be made: " + error.message());
    return std::make_unique<FolderLock>(folder);
}

std::vector<CouplingMode> modes_called(const std::string& names) {
    std::vector<CouplingMode> modes;
    for (std::size_t begin = 0; begin <= names.size();) {
        const std::size_t end = std::min(names.find(',', begin), names.size());
        const std::string name(trimmed(names.substr(begin, end - begin)));
        const auto mode =
            static_cast<CouplingMode>(choice_called("--modes", name, coupling_mode_names));
        if (std::ranges::find(modes, mode) != modes.end()) {
            throw LoadError({"--modes " + names},
                            fmt::format("names {} twice; expected every mode once", name));
        }
        modes.push_back(mode);
        begin = end + 1;
    }
    return modes;
}

OperatorManner manner_called(const std::string& name) {
    return static_cast<OperatorManner>(choice_called("--operator", name, operator_manner_names));
}

StudyResult play_trial(const StudyOptions& options, const StudyTrial& trial) {
    const auto mode = coupling_mode_names[static_cast<std::size_t>(trial.mode)];
    const SceneDescription scene =
        read_study_scene(options, {fmt::format("coupling.mode={}", mode), "hand.stroke=hold"});
    Simulation simulation = load_simulation(scene);
    const double rest = find_rest(scene, simulation);
    Draws draws(options.seed, trial_number(trial));
    StudyResult result{.trial = trial, .start_angstrom = rest + draw_start(draws)};
    const OperatorSettings person = draw_operator(options, trial, scene, rest, draws);
    SeekingOperator seeker(person, draws);
    const double wall = find_wall(simulation, result.start_angstrom);
    move_grabbed(simulation, result.start_angstrom);
    set_coupling(scene.coupling, simulation);  // for the touch of this start

    HandOrders orders;
    EmulatedOmniSettings omni = build_study_device(scene, {});
    omni.orders = &orders;
    omni.driver = HandDriver::Operator;
    EmulatedOmni device(omni);
    const auto step = [&](const HandPose& hand, const TouchModel& felt) {
        (void)step_simulation(simulation, hand, felt);
        return simulation.touch;
    };
    const auto on_tick = [&](const ServoTick& tick) {
        result.found_angstrom = tick.touch.molecule.place_angstrom.x();
        result.went_through = result.went_through || result.found_angstrom < wall;
        seeker.feel(tick.sent_newton.x(), result.found_angstrom);
        orders.post({.target_m = Vec3(seeker.wish_m(), 0, 0)});
        result.seconds += servo_tick_s;
    };
    const auto limit = static_cast<std::uint64_t>(std::ceil(options.limit_s / servo_tick_s));
    const auto ticks_per_step =
        static_cast<std::uint64_t>(std::lround(simulation.period_s / servo_tick_s));
    run_lockstep({limit, ticks_per_step}, build_servo_settings(scene, simulation, device.spec()),
                 device, simulation.touch, step, on_tick, [&] { return seeker.is_done(); });
    result.off_angstrom = result.found_angstrom - rest;
    result.is_finished = seeker.is_done();
    return result;
}

std::vector<StudyResult> play_study(
    const StudyOptions& options,
    const std::function<void(std::size_t done, std::size_t of)>& on_result) {
    std::vector<StudyTrial> trials;
    for (std::size_t participant = 1; participant <= options.operators; ++participant) {
        const auto own = plan_study(participant, options.rounds, options.modes, options.seed);
        trials.insert(trials.end(), own.begin(), own.end());
    }
    std::vector<StudyResult> results;
    for (const StudyTrial& trial : trials) {
        results.push_back(play_trial(options, trial));
        if (on_result) on_result(results.size(), trials.size());
    }
    return results;
}

int study_command(const StudyOptions& options) {
    check_study(options);
    if (options.operators == 0) return study_in_window(options);
    std::unique_ptr<FolderLock> lock;
    if (options.folder) {
        lock = make_study_folder(*options.folder, {"trials.csv", "summary.json", "line.csv"});
    }
    const bool is_watched = isatty(STDERR_FILENO) != 0;
    const std::vector<StudyResult> results =
        play_study(options, [&](std::size_t done, std::size_t of) {
            if (is_watched) fmt::print(stderr, "\r{} of {} trials ", done, of);
        });
    if (is_watched) fmt::print(stderr, "\r{:30}\r", "");
    const std::vector<StudyRow> rows = summarise_study(options.modes, results);
    const std::string summary = format_study_json(options, rows);
    if (options.folder) {
        write_text_files(std::vector<TextFile>{
            {*options.folder / "trials.csv", trial_names() + format_trials(results)},
            {*options.folder / "summary.json", summary},
            {*options.folder / "line.csv", format_line(options)}});
    }
    fmt::print("{}", options.json ? summary : format_study_table(rows));
    return 0;
}

}  // namespace palpa
