#include "tools/replay.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "scene/read_scene.h"
#include "session/replay.h"
#include "session/run_headless.h"
#include "simulation/simulation.h"
#include "tools/hands.h"
#include "tools/progress.h"
#include "tools/run.h"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

namespace palpa {
namespace {

SceneDescription read_session(const std::filesystem::path& folder) {
    const std::filesystem::path session = folder / "session.toml";
    std::error_code error;
    if (!std::filesystem::exists(session, error)) {
        throw LoadError({folder.string()},
                        "holds no session.toml; expected the folder of a recording (palpa run "
                        "--record)");
    }
    return read_scene(session, {});
}

void check_repeats(const SceneDescription& scene) {
    if (!scene.statics.budget_us) return;
    throw LoadError(
        scene.place_of("statics.budget_us"),
        "the session had a time budget, and how much moved hung on the machine's speed: "
        "such runs do not repeat; expected one without statics.budget_us");
}

// The session's file brings back the emulated hand, and no other. A recording that was cut off has
// no summary, and only the trace will tell.
void check_device(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "summary.json";
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return;
    const auto summary = nlohmann::json::parse(read_text_file(file), nullptr, false);
    if (!summary.is_object() || !summary.contains("device")) return;
    const std::string device =
        summary["device"].is_string() ? summary["device"].get<std::string>().substr(0, 80) : "";
    if (device == "emulated Omni") return;
    throw LoadError({(folder / "summary.json").string()},
                    fmt::format("the device was '{}'; expected one of the emulated hand (palpa run "
                                "--device replay:{} plays what was read then)",
                                device, folder.string()));
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
    fmt::print("{} of {} rows played again: ", check.compared(), check.recorded());
    if (check.different() == 0 && check.not_finite() > 0) {
        fmt::print("all the same, and not all finite\n");
    } else if (const auto& difference = check.first(); !difference) {
        fmt::print("all the same to the last digit\n");
    } else {
        const TraceDifference& first = *difference;
        fmt::print(
            "{} differ\n  first       row {}, {} s: {} was {}, now {}\n  forces      {:.3g} N "
            "apart "
            "at most\n",
            check.different(), first.row, printable(first.time_s), first.column,
            printable(first.recorded), first.played, check.largest_newton());
        fmt::print(
            "  The same bits come from the same program on the same kind of processor "
            "(session.toml says which).\n");
    }
    if (check.is_cut_off()) {
        fmt::print("  cut off     {:.7g} of {:.7g} s were recorded\n", time.recorded_s,
                   time.session_s);
    }
    if (check.not_finite() > 0)
        fmt::print("  not finite  a number in each of {} rows\n", check.not_finite());
    if (check.surplus() > 0)
        fmt::print("  too many    rows behind the session's end: {}\n", check.surplus());
}

}  // namespace

int replay_command(const ReplayOptions& options) {
    SceneDescription scene = read_session(options.recording);
    if (!options.verify) {
        RunOptions run;
        run.scene = options.recording / "session.toml";
        run.headless = true;
        run.json = options.json;
        return run_command(run);
    }
    check_repeats(scene);
    check_device(options.recording);
    TraceCheck check(options.recording, count_ticks(scene), scene.every);
    if (check.recorded() == 0) {
        throw LoadError({(options.recording / "trace.csv").string(), 2},
                        "holds no row; expected a recording that had begun");
    }
    // One that was cut off is played as far as it goes.
    const auto ticks = check.recorded() * static_cast<std::uint64_t>(scene.every);
    const double session_s = scene.seconds;
    scene.seconds = std::min(session_s, static_cast<double>(ticks) * servo_tick_s);
    const RecordedTime time{scene.seconds, session_s};
    ProgressLine progress;
    Simulation simulation = load_simulation(scene, progress.stages());
    progress.wipe();
    EmulatedOmni device(build_emulated_omni(scene, simulation));
    (void)run_headless(scene, simulation, device, {}, nullptr, find_progress(options.json), {},
                       [&](const ServoTick& tick) { check.add(tick); });
    if (options.json) {
        fmt::print("{}\n", as_json(check, time).dump(2));
    } else {
        print_check(check, time);
    }
    const bool is_whole = check.compared() == check.recorded();
    return check.different() == 0 && check.not_finite() == 0 && is_whole ? 0 : 1;
}

}  // namespace palpa
