#include "tools/commands/run.h"

#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "devices/open_device.h"
#include "experiments/emulated_hand.h"
#include "loading/engine_atoms.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/lesson_meter.h"
#include "session/pack_recording.h"
#include "session/recording.h"
#include "session/run_headless.h"
#include "session/statistics_file.h"
#include "session/trajectory_recorder.h"
#include "simulation/grip_queries.h"
#include "simulation/remote_engine.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "simulation/systems/follow_engine.h"
#include "tools/commands/command.h"
#include "tools/commands/devices.h"
#include "tools/commands/open_window.h"
#include "tools/commands/print_run.h"
#include "tools/commands/progress.h"
#include "tools/commands/render.h"
#include "tools/commands/scripted.h"
#include "view/worded_picture.h"

#include <fmt/format.h>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// A frame that cannot be drawn or written is the last one; the run goes on.
void write_frame(std::unique_ptr<FrameWriter>& writer, World& world, ProgressLine& progress) {
    if (!writer) return;
    try {
        writer->write(world);
    } catch (const std::runtime_error& error) {
        progress.wipe();
        fmt::print(stderr, "warning: no further frames are written: {}\n", error.what());
        writer.reset();
    }
}

// Without a window nobody is there.
void check_headless(const char* option, const std::string& device) {
    const DeviceMaker& maker = device_maker_called(device);
    if (maker.is_emulated && !maker.needs_window) return;
    throw LoadError({fmt::format("{} {}", option, device)},
                    "needs a person and a window, but this run has no window (--headless)");
}

}  // namespace

TrajectorySettings trajectory_settings(const RunOptions& options, bool can_be_replayed) {
    TrajectorySettings settings{.writes_xtc = options.trajectory_xtc};
    if (can_be_replayed && !options.trajectory_xtc) settings.per_second = 0;
    if (!options.trajectory_fps) return settings;
    settings.per_second = *options.trajectory_fps;
    settings.most_bytes.reset();  // who asks gets all of it
    return settings;
}

std::optional<PlaybackChoice> playback_choice(const RunOptions& options) {
    if (!options.trajectory) return std::nullopt;
    PlaybackOrder order{.paused = options.trajectory_speed == 0,
                        .frames_per_s = options.trajectory_speed,
                        .frame = options.trajectory_frame - 1};
    if (*order.paused) order.frames_per_s.reset();  // that of whoever lets it play
    return PlaybackChoice{*options.trajectory, order};
}

namespace {

// What can be said of the options before anything is loaded.
void check_options(const RunOptions& options) {
    if (options.check_only) return;
    if (!options.trajectory && (options.trajectory_speed != 25 || options.trajectory_frame != 1)) {
        throw LoadError(
            {options.trajectory_speed != 25 ? "--trajectory-speed" : "--trajectory-frame"},
            "needs a trajectory; expected --trajectory FILE with it");
    }
    if (options.commands && !options.headless) {
        throw LoadError({"--commands"},
                        "needs a run without a window; expected --headless with it");
    }
    if (options.commands && options.json) {
        throw LoadError({"--json"},
                        "cannot be combined with --commands, because both write to standard "
                        "output; expected one of them");
    }
    if (options.compresses && !options.record) {
        throw LoadError({"--compress"}, "needs a recording; expected --record FOLDER with it");
    }
    if (!options.headless) return check_window_options(options);
    if (options.record) check_record_folder(*options.record, options.overwrites);
    if (!options.record && (options.trajectory_fps || options.trajectory_xtc)) {
        throw LoadError({options.trajectory_fps ? "--trajectory-fps" : "--trajectory-xtc"},
                        "needs a recording; expected --record FOLDER with it");
    }
    if (options.last_shot || options.play || options.sound) {
        throw LoadError({options.play    ? "--play"
                         : options.sound ? "--sound"
                                         : "--shot"},
                        "needs a window, but this run has none (--headless)");
    }
    if (options.device) check_headless("--device", *options.device);
    if (options.second) check_headless("--second", *options.second);
}

void check_second(const RunOptions& options, const SceneDescription& scene) {
    if (!options.second || scene.hands.size() > 1) return;
    throw LoadError({fmt::format("--second {}", *options.second)},
                    "needs a scene of two hands ([[hand]]), such as water/two-hands or "
                    "hiv/two-hands");
}

int print_check(const SceneDescription& scene, const World& world,
                const std::vector<std::string>& warnings, ProgressLine& progress) {
    fmt::print("{}: {}\n", printable(scene.file.string()),
               warnings.empty() ? "no problems found"
                                : fmt::format("the scene can run, with {} warning{}",
                                              warnings.size(), warnings.size() == 1 ? "" : "s"));
    if (scene.engine) {
        fmt::print("  engine      {} moves {} atoms\n", printable(scene.engine->address),
                   world.resource<AtomTable>().size());
    } else {
        print_line(scene, world, progress);
    }
    for (const std::string& warning : warnings) {
        fmt::print("  warning: {}\n", printable(warning));
    }
    return 0;
}

// Nothing where no frames are asked for; where they cannot be drawn a warning says so.
std::unique_ptr<FrameWriter> open_frames(const RunOptions& options, const ViewDescription& view,
                                         std::vector<std::string>& warnings) {
    if (!options.record || options.frames_per_second <= 0) return nullptr;
    try {
        std::vector<std::string> lacking;
        auto writer =
            std::make_unique<FrameWriter>(*options.record / "frames", options.frame_width,
                                          options.frame_height, view, open_words(lacking));
        warnings.insert(warnings.end(), lacking.begin(), lacking.end());
        return writer;
    } catch (const GpuError& error) {
        warnings.push_back(fmt::format("frames cannot be drawn: {}", error.what()));
        return nullptr;
    }
}

// The scene's hands on their devices.
std::vector<std::unique_ptr<Device>> open_hands(const SceneDescription& scene, const World& world,
                                                const RunOptions& options) {
    std::vector<std::unique_ptr<Device>> devices;
    std::vector<std::optional<std::string>> named{options.device, options.second};
    named.resize(std::max(named.size(), scene.hands.size()));
    for (std::size_t slot = 0; slot < scene.hands.size(); ++slot) {
        devices.push_back(open_device(named[slot].value_or("emulated"),
                                      {.emulated = build_emulated_omni(scene, world, slot)})
                              .device);
    }
    return devices;
}

// A recording that cannot be compressed is whole, and a warning says so.
void compress(const std::filesystem::path& recording, ProgressLine& progress) {
    try {
        pack_recording(recording, progress.shares("compressing"));
    } catch (const LoadError& error) {
        progress.wipe();
        fmt::print(stderr, "warning: the recording is not compressed: {}\n", error.what());
    }
    progress.wipe();
}

// In lockstep, without a window.
int run_without_window(SceneDescription scene, World& world,
                       std::span<const std::unique_ptr<Device>> devices, const RunOptions& options,
                       std::vector<std::string> warnings, std::unique_ptr<FrameWriter> writer,
                       ProgressLine& progress) {
    note_interrupts();  // a recording that is begun is ended in order
    std::optional<Recording> recording;
    if (options.record)
        recording.emplace(*options.record, scene, options.overwrites, devices.size(),
                          options.trajectory ? RecordedBy::Trajectory
                          : options.commands ? RecordedBy::Commands
                                             : RecordedBy::Hand);
    if (recording) recording->begin_trajectory(trajectory_settings(options));
    std::vector<Device*> hands;
    for (const std::unique_ptr<Device>& device : devices) hands.push_back(device.get());
    if (options.record && (options.second.value_or("emulated") != "emulated" ||
                           options.device.value_or("emulated") != "emulated")) {
        warnings.emplace_back(
            "to run this recording's session.toml again, give --device and --second again; without "
            "them it uses the scene's hand");
    }
    if (options.record && options.trajectory) {
        warnings.emplace_back(
            "this recording does not contain the trajectory's frames, so it cannot be replayed");
    }
    const std::unique_ptr<FrameServer> server =
        open_server(options.serve, world, !options.json && !options.commands);
    std::optional<ServedRun> served;
    if (server) served.emplace(*server, options.serve, progress);
    std::optional<ScriptedRun> scripted;
    if (options.commands) scripted.emplace(scene, standard_ends(devices, options.overwrites));
    std::optional<StatisticsFile> statistics;
    if (options.statistics) statistics.emplace(*options.statistics, options.overwrites);
    const auto before_step = [&](World& next, const EditFunction& edit) {
        const double last_us = next.resource<StepReport>().took_us;
        if (statistics && last_us > 0) statistics->add_step(last_us);
        if (scripted) scripted->before_step(next, edit);
        if (served) served->before_step(next);
    };
    HandTicksFunction watch;
    if (scripted || statistics) {
        watch = [&](std::span<const ServoTick> ticks) {
            if (scripted) scripted->add(ticks);
            if (statistics) statistics->add(ticks.front());
        };
    }
    FrameClock frames;
    if (writer) {
        frames = {options.frames_per_second, [&] { write_frame(writer, world, progress); }};
    }
    print_warnings(warnings);
    const auto is_over = [&] {
        return noted_interrupt() != 0 || is_engine_gone(world) || (scripted && scripted->is_over());
    };
    const Summary summary =
        run_headless(scripted ? without_end(scene) : scene, world, hands, warnings,
                     recording ? &*recording : nullptr, progress.shares("playing"), frames, watch,
                     is_over, before_step);
    progress.wipe();
    const bool is_gone = is_engine_gone(world);
    const std::string engine =
        is_gone ? describe_engine(world) + "; " + report_engine(world)->advice : std::string();
    leave_engine(world);
    if (noted_interrupt() != 0 || is_gone)
        scene.seconds = static_cast<double>(summary.ticks) / servo_rate_hz;
    print_warnings(std::span(summary.warnings).subspan(warnings.size()));
    if (recording) print_notes(recording->take_notes());
    recording.reset();
    if (options.compresses) compress(*options.record, progress);
    if (options.json) {
        fmt::print("{}", format_summary(scene, summary));
    } else if (!scripted) {
        print_summary(scene, summary);
        if (options.record) fmt::print("recorded in {}\n", options.record->string());
    }
    if (is_gone) fmt::print(stderr, "{}\n", printable(engine));
    const bool is_refused = scripted && scripted->has_refused();
    return exit_code_after(is_gone ? engine_lost : is_refused ? command_refused : 0);
}

// Without a window the run goes by the engine's frames; a window, which connects by itself, only
// needs to know where atoms are.
void await_first_frame(const SceneDescription& scene, World& world, const RunOptions& options,
                       ProgressLine& progress) {
    if (!scene.engine || options.check_only) return;
    if (!options.headless && !lacks_coordinates(scene)) return;
    tell(progress.stages(), "waiting for the engine's first frame");
    begin_with_engine(world);
    options.headless ? make_steps_wait(world) : leave_engine(world);
}

}  // namespace

int run_command(const RunOptions& options) {
    return run_scene(read_scene(options.scene, options.settings), options);
}

int run_scene(const SceneDescription& read, const RunOptions& options) {
    const SceneDescription scene = options.trajectory ? as_played(read) : read;
    check_options(options);
    check_second(options, scene);
    ProgressLine progress(!options.json && !options.commands);
    World world = load_world(scene, progress.stages());
    await_first_frame(scene, world, options, progress);
    const std::optional<PlaybackChoice> playback = playback_choice(options);
    if (playback) start_playback(world, playback->file, playback->order);
    tell(progress.stages(), "planning the path of the hand");
    const EmulatedOmniSettings settings = build_emulated_omni(scene, world);
    std::vector<std::string> warnings =
        list_warnings(scene, world, settings.script, progress.stages());
    for (std::size_t slot = 1; slot < scene.hands.size(); ++slot) {
        const HandScript script = build_emulated_omni(scene, world, slot).script;
        for (std::string& warning :
             list_hand_warnings(scene, world, script, slot, progress.stages()))
            warnings.push_back(std::move(warning));
    }
    for (std::string& note : list_playback_notes(world)) warnings.push_back(std::move(note));
    progress.wipe();
    if (options.check_only) {
        (void)LessonMeter(scene, world);  // throws for selections of a lesson that are none
        return print_check(scene, world, warnings, progress);
    }
    if (!options.headless) {
        print_warnings(list_playback_notes(world));
        return exit_code_after(open_window(scene, world, settings, options));
    }
    // Complaints about the size of frames come before a recording is begun.
    std::unique_ptr<FrameWriter> writer = open_frames(options, scene.view, warnings);
    // Until the run begins a signal ends the program at once, however long a file takes to be read.
    const std::vector<std::unique_ptr<Device>> devices = open_hands(scene, world, options);
    return run_without_window(scene, world, devices, options, std::move(warnings),
                              std::move(writer), progress);
}

namespace {

void add_window_options(CLI::App& run, RunOptions& options) {
    run.option_defaults()->group("In a window");
    run.add_flag("--play", options.play,
                 "the emulated hand plays the scene's stroke in place of the mouse");
    run.add_flag("--sound", options.sound,
                 "play the force as a tone: stronger is higher and louder");
    add_size_option(run, "--size", options.width, options.height);
    run.get_option("--size")->each([&options](const std::string&) { options.has_size = true; });
    run.add_option("--files,--screenshots", options.files_folder,
                   "folder for what the window saves (default: Palpa in your documents)")
        ->type_name("FOLDER");
    run.add_option("--actions", options.actions,
                   "CSV file: a row for each action of the person ('palpa help actions')")
        ->type_name("FILE");
    CLI::Option* const shot =
        run.add_option("--shot", options.last_shot,
                       "save a screenshot to this file, then close the window")
            ->type_name("FILE.png");
    run.add_option("--after", options.last_shot_s, "seconds until --shot (default 5)")
        ->check(in_range(0.0, 1e5))
        ->needs(shot);
    run.add_flag("--validation", options.validation,
                 "check the drawing by the Vulkan validation layer");
    run.add_option("--lose-device-at", options.lose_device_at)->group("");  // a test's
}

void add_serve_options(CLI::App& run, ServeChoice& serve) {
    run.option_defaults()->group("Other programs (IMD)");
    CLI::Option* const port = run.add_option("--serve", serve.port,
                                             "serve frames to VMD, imdclient and others, which may "
                                             "pull, on this port (0: a free one)")
                                  ->check(in_range(0, 65535))
                                  ->type_name("PORT");
    run.add_option("--serve-version", serve.options.version, "IMD version, 2 or 3 (default 2)")
        ->check(CLI::IsMember({2, 3}))
        ->needs(port);
    run.add_option("--listen", serve.options.address,
                   "address of this machine on which to listen, without a password (default "
                   "127.0.0.1: only clients on this machine)")
        ->type_name("ADDRESS")
        ->needs(port);
    run.add_option("--serve-rate", serve.options.rate,
                   "steps between frames, unless a client requests others (default: about 30 "
                   "frames per second)")
        ->check(in_range(1, 1e9))
        ->type_name("N")
        ->needs(port);
    run.add_flag("--serve-wait", serve.waits, "wait until the first client starts (headless)")
        ->needs(port);
    run.add_flag("--serve-fast", serve.is_as_fast,
                 "run as fast as possible, not in real time (headless)")
        ->needs(port);
}

void add_headless_options(CLI::App& run, RunOptions& options) {
    run.option_defaults()->group("Without a window");
    run.add_flag("--headless", options.headless,
                 "run without a window, in lockstep on a virtual clock: the same command gives "
                 "identical results");
    CLI::Option* const record =
        run.add_option("--record", options.record,
                       "record into this folder: trace.csv, summary.json, session.toml, "
                       "trajectory.dcd with system.psf, frames; with a window trace.csv.gz and "
                       "journal.txt.gz")
            ->type_name("FOLDER")
            ->group("With and without a window");
    add_overwrite_flag(run, options.overwrites);
    run.get_option("--overwrite")->group("With and without a window");
    run.add_option("--statistics", options.statistics,
                   "CSV file: every second of the servo a row of step times, overruns, force and "
                   "energy")
        ->type_name("FILE")
        ->group("With and without a window");
    run.add_flag("--compress", options.compresses,
                 "compress the recording's trace.csv to trace.csv.gz, as a window always does");
    run.add_option(
           "--fps", options.frames_per_second,
           "add pictures frames/0000.png ... to the recording, this many per simulated second")
        ->check(in_range(0.01, 1000.0))
        ->needs(record);
    add_size_option(run, "--frame-size", options.frame_width, options.frame_height);
    run.add_option(
           "--trajectory", options.trajectory,
           "play this trajectory of the scene's atoms: .dcd, .xtc, .trr, or models of .pdb or .cif")
        ->type_name("FILE")
        ->group("With and without a window");
    run.add_option("--trajectory-speed", options.trajectory_speed,
                   "frames of the trajectory per second (default 25; 0: it stands still)")
        ->check(in_range(0.0, 1e5))
        ->group("With and without a window");
    run.add_option("--trajectory-frame", options.trajectory_frame,
                   "first frame to show, counted from 1")
        ->check(in_range(1.0, 1e9))
        ->group("With and without a window");
    run.add_option("--trajectory-fps", options.trajectory_fps,
                   "frames of the recording's trajectory.dcd per simulated second, 0 for none "
                   "(default 25, up to 256 MiB; with a window none, since 'palpa replay FOLDER "
                   "--trajectory-fps 25' makes them)")
        ->check(in_range(0.0, 1000.0))
        ->group("With and without a window");
    run.add_flag("--trajectory-xtc", options.trajectory_xtc, "also write trajectory.xtc")
        ->group("With and without a window");
    run.add_flag(
        "--commands", options.commands,
        "read commands from standard input, one a line, and answer each with a line of JSON");
    run.add_flag("--json", options.json, "print the summary as JSON");
}

}  // namespace

void add_run(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& run = *program.add_subcommand("run", "Run a scene in a window, or without one");
    RunOptions& options = own_options<RunOptions>(run, chosen, run_command);
    describe(run, {"palpa run hiv", "palpa run scenes/water --headless --record recordings/water",
                   "palpa run scenes/water --headless --mode 2 --period-ms 14 --friction 0",
                   "palpa run scenes/hiv/flexible.toml --play",
                   "palpa run scenes/hiv --trajectory others.xtc",
                   "palpa run scenes/hiv/flexible.toml --headless --serve 8888"});
    run.add_option("scene", options.scene,
                   "scene folder or file, recorded session.toml, or name of one of Palpa's scenes")
        ->required();
    run.add_flag("--check", options.check_only, "only read the scene and print its problems");
    run.option_defaults()->group("Hand and device");
    run.add_option_function<std::string>(
        "--device",
        [&options](const std::string& name) {
            if (name == "list") {
                print_device_list();
                throw CLI::Success();
            }
            options.device = name;
        },
        "haptic device (default: mouse; without a window: emulated); 'list' lists all");
    run.add_option("--second", options.second,
                   "device of the second hand of a scene (default: arrow keys in a window)");
    std::vector<std::string>& settings = options.settings;
    add_setting(run, "--hand",
                "grip of the emulated hand: none, light, slack, medium, firm or firm-grip",
                settings);
    add_setting(run, "--friction", "Coulomb friction of the emulated device, N", settings);
    run.option_defaults()->group("Coupling and simulation");
    add_setting(run, "--mode", "coupling mode: guarded, or 1 to 5 as in the paper", settings);
    add_setting(run, "--period-ms", "time between two steps of the simulation, ms", settings);
    add_setting(
        run, "--engage",
        "when the force of guarded coupling begins: at-once, or ramp (after quiet ticks, over 2 s)",
        settings);
    add_setting(run, "--seconds", "length of the run, s", settings);
    add_setting(run, "--seed", "random seed (default 1)", settings);
    add_setting(run, "--every", "write every Nth row of the trace", settings);
    add_set_option(run, settings);
    add_window_options(run, options);
    add_headless_options(run, options);
    add_serve_options(run, options.serve);
}

}  // namespace palpa
