#include "tools/commands/replay.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "formats/gzip.h"
#include "loading/load.h"
#include "scene/find_scene.h"
#include "session/journal.h"
#include "session/play_journal.h"
#include "session/recording.h"
#include "session/replay.h"
#include "session/run_headless.h"
#include "session/trajectory_recorder.h"
#include "simulation/grip_queries.h"
#include "tools/commands/command.h"
#include "tools/commands/kernels.h"
#include "tools/commands/progress.h"
#include "tools/commands/run.h"
#include "tools/commands/screens.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

namespace palpa {
namespace {

void check_repeats(const SceneDescription& scene) {
    if (!scene.statics.budget_us) return;
    throw LoadError(scene.place_of("statics.budget_us"),
                    "cannot be replayed exactly: with a time budget the result depends on the "
                    "speed of the machine; expected a recording without statics.budget_us");
}

// The session's file brings back the emulated hand, and no other. A recording that was cut off has
// no summary, and only the trace will tell.
void check_device(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "summary.json";
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return;
    const auto summary = nlohmann::json::parse(read_text_file(file), nullptr, false);
    const auto check = [&](const nlohmann::json& hand) {
        if (!hand.is_object() || !hand.contains("device")) return;
        const std::string device =
            hand["device"].is_string() ? hand["device"].get<std::string>().substr(0, 80) : "";
        if (device == "emulated Omni") return;
        throw LoadError({(folder / "summary.json").string()},
                        fmt::format("the device was '{}'; expected a recording of the emulated "
                                    "hand (to play these readings: palpa run --device replay:{})",
                                    device, folder.string()));
    };
    check(summary);
    for (std::size_t hand = 2; summary.is_object() && hand <= most_hands; ++hand) {
        const std::string key = fmt::format("hand_{}", hand);
        if (summary.contains(key)) check(summary[key]);
    }
}

// What clients pulled is in no recording but a window's, which has a journal.
void check_no_client_pulled(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "summary.json";
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return;
    const auto summary = nlohmann::json::parse(read_text_file(file), nullptr, false);
    if (!summary.is_object() || !summary.contains("client_pulls")) return;
    throw LoadError({file.string()},
                    "cannot be replayed: clients pulled in this run (--serve) and the recording "
                    "does not have their forces; expected a run without pulling clients, or one of "
                    "a window (its journal has the forces)");
}

// How much of a session is there.
struct RecordedTime {
    double recorded_s, session_s;
};

nlohmann::ordered_json as_json(const TraceCheck& check, const RecordedTime& time) {
    nlohmann::ordered_json json{
        {"recorded", check.recorded()},       {"compared", check.compared()},
        {"different", check.different()},     {"cut_off", check.is_cut_off()},
        {"recorded_s", time.recorded_s},      {"session_s", time.session_s},
        {"surplus", check.surplus()},         {"not_finite", check.not_finite()},
        {"largest_N", check.largest_newton()}};
    if (const auto& first = check.first()) {
        json["first"] = {{"row", first->row},
                         {"time_s", first->time_s},
                         {"column", first->column},
                         {"recorded", first->recorded},
                         {"played", first->played}};
    }
    return json;
}

void print_check(const TraceCheck& check, const RecordedTime& time) {
    fmt::print("replayed {} of {} rows: ", check.compared(), check.recorded());
    if (check.different() == 0 && check.not_finite() > 0) {
        fmt::print("all identical, but not all finite\n");
    } else if (const auto& difference = check.first(); !difference) {
        fmt::print("all identical to the last digit\n");
    } else {
        const TraceDifference& first = *difference;
        fmt::print(
            "{} differ\n  first       row {}, {} s: {} was {}, now {}\n  forces      differ by at "
            "most {:.3g} N\n",
            check.different(), first.row, printable(first.time_s), first.column,
            printable(first.recorded), first.played, check.largest_newton());
        fmt::print(
            "  Identical results need the same version and kernels, which session.toml names, and "
            "but for SCALAR a processor of the same maker.\n");
    }
    if (check.is_cut_off()) {
        fmt::print("  cut off     {:.7g} of {:.7g} s were recorded\n", time.recorded_s,
                   time.session_s);
    }
    if (check.not_finite() > 0)
        fmt::print("  not finite  a number in each of {} rows\n", check.not_finite());
    if (check.surplus() > 0)
        fmt::print("  too many    rows after the end of the session: {}\n", check.surplus());
}

int report(const TraceCheck& check, const RecordedTime& time, bool json) {
    if (json) {
        fmt::print("{}\n", as_json(check, time).dump(2));
    } else {
        print_check(check, time);
    }
    const bool is_whole = check.compared() == check.recorded();
    return check.different() == 0 && check.not_finite() == 0 && is_whole ? 0 : 1;
}

void check_has_rows(const TraceCheck& check) {
    if (check.recorded() > 0) return;
    throw LoadError({check.file(), 2}, "has no rows; expected a recording with at least one row");
}

// Writes the atoms of a session into the folder of its recording, as a run does that records them.
class AtomsWriter {
public:
    explicit AtomsWriter(const ReplayOptions& options)
        : lock_(options.recording),
          sampler_(*options.trajectory_fps),
          files_(options.recording, {.per_second = *options.trajectory_fps,
                                     .writes_xtc = options.trajectory_xtc,
                                     .most_bytes = std::nullopt}) {
        for (const char* const name : {"trajectory.dcd", "trajectory.xtc", "system.psf"}) {
            std::error_code error;
            const std::filesystem::path file = options.recording / name;
            if (std::filesystem::exists(file, error))
                throw LoadError({file.string()}, "already exists; expected a recording without it");
        }
    }

    void add(const LiveSimulation& simulation) {
        const World& world = simulation.world();
        if (const auto shot = sampler_.take(world, time_s_, simulation.edition()))
            files_.add(*shot);
        time_s_ += world.resource<Clock>().period_s;
    }

    void close() {
        files_.close();
        print_notes(files_.take_notes());
    }

private:
    FolderLock lock_;
    TrajectorySampler sampler_;
    TrajectoryFiles files_;
    double time_s_ = 0;
};

// What people did in a window.
int replay_journal(const ReplayOptions& options, const SceneDescription& scene) {
    const std::filesystem::path file = find_plain_or_packed(options.recording / journal_name);
    Journal journal = parse_journal(read_recorded_file(file), file.string());
    complete_caps(scene, journal);
    const std::size_t recorded =
        journal.ticks.size() - journal.first_recorded.value_or(journal.ticks.size());
    TraceCheck check(options.recording, recorded, scene.every, journal.devices.size());
    check_has_rows(check);
    print_notes(scene.notes);
    print_notes(journal.notes);
    print_notes(check.notes());
    std::optional<AtomsWriter> atoms;
    StepsFunction on_step;
    if (options.trajectory_fps) {
        atoms.emplace(options);
        on_step = [&](const LiveSimulation& simulation) { atoms->add(simulation); };
    }
    ProgressLine progress(!options.json);
    std::vector<ServoTick> played(journal.devices.size());
    play_journal(
        scene, journal,
        [&](std::span<const LiveTick> ticks) {
            std::ranges::transform(ticks, played.begin(), &LiveTick::tick);
            check.add(played);
        },
        progress.shares("playing"), on_step);
    progress.wipe();
    if (atoms) atoms->close();
    const double recorded_s = static_cast<double>(recorded) * servo_tick_s;
    return report(check, {recorded_s, recorded_s}, options.json);
}

}  // namespace

int replay_command(const ReplayOptions& options) {
    SceneDescription scene = read_recorded_scene(options.recording);
    if (options.window) return open_screens({.files = {options.recording}});
    const RecordedKernels kernels(options.recording);
    if (has_journal(options.recording)) return replay_journal(options, scene);
    if (options.trajectory_fps)
        throw LoadError({options.recording.string()},
                        "has no journal, so it was recorded without a window; expected 'palpa run "
                        "FOLDER/session.toml --headless --record NEW_FOLDER --trajectory-fps N'");
    check_no_client_pulled(options.recording);
    if (!options.verify) {
        RunOptions run;
        run.scene = options.recording / "session.toml";
        run.headless = true;
        run.json = options.json;
        return run_command(run);
    }
    check_repeats(scene);
    check_device(options.recording);
    const std::size_t hands = scene.hands.size();
    TraceCheck check(options.recording, count_ticks(scene), scene.every, hands);
    check_has_rows(check);
    print_notes(scene.notes);
    print_notes(check.notes());
    // One that was cut off is played as far as it goes.
    const auto ticks = check.recorded() * static_cast<std::uint64_t>(scene.every);
    const double session_s = scene.seconds;
    scene.seconds = std::min(session_s, static_cast<double>(ticks) * servo_tick_s);
    const RecordedTime time{scene.seconds, session_s};
    ProgressLine progress(!options.json);
    World world = load_world(scene, progress.stages());
    std::vector<std::unique_ptr<EmulatedOmni>> omnis;
    std::vector<Device*> devices;
    for (std::size_t slot = 0; slot < hands; ++slot) {
        omnis.push_back(std::make_unique<EmulatedOmni>(build_emulated_omni(scene, world, slot)));
        devices.push_back(omnis.back().get());
    }
    (void)run_headless(scene, world, devices, {}, nullptr, progress.shares("playing"), {},
                       [&](std::span<const ServoTick> ticks) { check.add(ticks); });
    progress.wipe();
    return report(check, time, options.json);
}

void add_replay(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& replay = *program.add_subcommand(
        "replay", "Replay a recorded session; --verify checks that every digit is the same");
    ReplayOptions& options = own_options<ReplayOptions>(replay, chosen, replay_command);
    describe(replay,
             {"palpa replay recordings/water --verify", "palpa replay recordings/session --window",
              "palpa replay recordings/session --trajectory-fps 25"});
    replay.add_option("recording", options.recording, "folder of palpa run --record")->required();
    replay.add_flag("--window", options.window,
                    "in a window, where a recorded session of a window can be stopped and looked "
                    "at; every row is compared there too");
    replay.add_flag("--verify", options.verify,
                    "compare every row of the trace with the replay; exit code 1 if one differs");
    CLI::Option* const fps =
        replay
            .add_option("--trajectory-fps", options.trajectory_fps,
                        "of a window's recording: add trajectory.dcd with system.psf to its "
                        "folder, this many frames per simulated second")
            ->check(in_range(0.01, 1000.0));
    replay.add_flag("--trajectory-xtc", options.trajectory_xtc, "also add trajectory.xtc")
        ->needs(fps);
    replay.add_flag("--json", options.json, "print the result as JSON");
}

}  // namespace palpa
