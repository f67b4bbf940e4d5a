#include "tools/run.h"

#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "devices/open_device.h"
#include "devices/two_hands.h"
#include "scene/fields.h"
#include "scene/read_scene.h"
#include "session/recording.h"
#include "session/run_headless.h"
#include "simulation/simulation.h"
#include "simulation/step.h"
#include "tools/hands.h"
#include "tools/open_window.h"
#include "tools/print_run.h"
#include "tools/relax.h"
#include "tools/render.h"

#include <fmt/format.h>
#include <unistd.h>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpa {
namespace {

// Shown where a person watches, over a line of its own.
void show_progress(double share) {
    fmt::print(stderr, "\r{:3.0f} %", 100 * share);
    if (share >= 1) fmt::print(stderr, "\r      \r");
    std::fflush(stderr);
}

// A frame that cannot be drawn or written is the last one; the run goes on.
void write_frame(std::unique_ptr<FrameWriter>& writer, Simulation& simulation) {
    if (!writer) return;
    try {
        writer->write(simulation);
    } catch (const std::runtime_error& error) {
        fmt::print(stderr, "warning: no more frames: {}\n", error.what());
        writer.reset();
    }
}

// Without a window nobody is there.
void check_headless(const std::string& device) {
    const DeviceMaker& maker = device_maker_called(device);
    if (maker.is_emulated && !maker.needs_window) return;
    throw LoadError({fmt::format("--device {}", device)},
                    "is held by a person and needs the window; this run has none (headless)");
}

// Two equal handles with a spring between them are as one of half the mass and damping.
void hold_with_both_hands(SceneDescription& scene) {
    DeviceDescription& device = scene.device;
    device.inertia_kg = in_series(device.inertia_kg, device.inertia_kg);
    device.viscosity_N_s_per_m = in_series(device.viscosity_N_s_per_m, device.viscosity_N_s_per_m);
}

}  // namespace

ProgressFunction find_progress(bool json) {
    return isatty(STDERR_FILENO) != 0 && !json ? ProgressFunction(show_progress)
                                               : ProgressFunction();
}

void print_scene_keys() {
    fmt::print("| key | value | unless given | meaning |\n| --- | --- | --- | --- |\n");
    for (const FieldNote& field : list_fields()) {
        fmt::print("| `{}` | {} | {} | {} |\n", field.key, field.type, field.fallback,
                   field.meaning);
    }
}

namespace {

// What can be said of the options before anything is loaded.
void check_options(const RunOptions& options) {
    if (options.check_only) return;
    if (!options.headless) return check_window_options(options);
    if (options.record) check_record_folder(*options.record, options.overwrites);
    if (options.last_shot || options.play || options.sound) {
        throw LoadError({options.play    ? "--play"
                         : options.sound ? "--sound"
                                         : "--shot"},
                        "needs the window, and this run has none (headless)");
    }
    if (options.device) check_headless(*options.device);
}

int print_check(const SceneDescription& scene, const Simulation& simulation,
                const std::vector<std::string>& warnings) {
    fmt::print("{}: {}\n", printable(scene.file.string()),
               warnings.empty() ? "nothing wrong found"
                                : fmt::format("can be run, with {} warning{}", warnings.size(),
                                              warnings.size() == 1 ? "" : "s"));
    print_line(scene, simulation);
    for (const std::string& warning : warnings) {
        fmt::print("  warning: {}\n", printable(warning));
    }
    return 0;
}

}  // namespace

int run_command(const RunOptions& options) {
    const SceneDescription as_read = read_scene(options.scene, options.settings);
    check_options(options);
    SceneDescription scene = as_read;
    Simulation simulation = load_simulation(scene, show_relaxing());
    const EmulatedOmniSettings settings = build_emulated_omni(scene, simulation);
    if (options.second) hold_with_both_hands(scene);
    std::vector<std::string> warnings = list_warnings(scene, simulation, settings.script);
    if (options.check_only) return print_check(scene, simulation, warnings);
    if (!options.headless) {
        return exit_code_after(open_window(scene, as_read, simulation, settings, options));
    }
    std::unique_ptr<FrameWriter> writer;
    if (options.record && options.frames_per_second > 0) {
        try {  // its complaints about the size come before a recording is begun
            writer = std::make_unique<FrameWriter>(*options.record / "frames", options.frame_width,
                                                   options.frame_height, scene.view);
        } catch (const GpuError& error) {
            warnings.push_back(fmt::format("no frames are drawn: {}", error.what()));
        }
    }
    // A signal ends the program at once until here, however long a file takes to be read.
    std::unique_ptr<Device> device =
        open_device(options.device.value_or("emulated"), {.emulated = settings}).device;
    const std::unique_ptr<Device> second = open_second(options.second, options.headless, settings);
    if (second) device = std::make_unique<TwoHands>(std::move(device), *second);
    note_interrupts();  // a recording that is begun is ended in order
    std::optional<Recording> recording;
    if (options.record) recording.emplace(*options.record, scene, options.overwrites);
    if (options.record && (options.second || options.device.value_or("emulated") != "emulated")) {
        warnings.emplace_back(
            "session.toml of this recording plays the scene's own hand; whoever runs it again has "
            "to name --device and --second again");
    }
    FrameClock frames;
    if (writer) frames = {options.frames_per_second, [&] { write_frame(writer, simulation); }};
    for (const std::string& warning : warnings) {
        fmt::print(stderr, "warning: {}\n", printable(warning));
    }

    const Summary summary = run_headless(
        scene, simulation, *device, warnings, recording ? &*recording : nullptr,
        find_progress(options.json), frames, {}, [] { return noted_interrupt() != 0; });
    if (noted_interrupt() != 0) scene.seconds = static_cast<double>(summary.ticks) / servo_rate_hz;
    for (std::size_t i = warnings.size(); i < summary.warnings.size(); ++i) {
        fmt::print(stderr, "warning: {}\n", printable(summary.warnings[i]));
    }
    if (options.json) {
        fmt::print("{}", format_summary(scene, summary));
    } else {
        print_summary(scene, summary);
        if (options.record) fmt::print("recorded in {}\n", options.record->string());
    }
    return exit_code_after(0);
}

}  // namespace palpa
