#include "tools/open_window.h"

#include "app/run_window.h"
#include "core/files.h"
#include "core/load_error.h"
#include "haptics/hand.h"
#include "render/picture.h"
#include "scene/read_scene.h"
#include "session/recording.h"
#include "tools/hands.h"
#include "tools/print_run.h"
#include "tools/save_scene.h"
#include "tools/window_devices.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// Asked for, or else chosen last.
SoundChoice build_sound_choice(const RunOptions& options, PreferencesFile& preferences) {
    return {.is_on = options.sound || preferences.now().sound.value_or(false),
            .remember = [&preferences](bool is_on) {
                Preferences chosen = preferences.now();
                chosen.sound = is_on;
                preferences.keep(chosen);
            }};
}

// What cannot be remembered keeps nobody from working.
void remember_scene(const fs::path& scene, PreferencesFile& preferences) {
    std::error_code error;
    Preferences chosen = preferences.now();
    chosen.scene = fs::absolute(scene, error).lexically_normal().string();
    try {
        preferences.keep(chosen);
    } catch (const LoadError& problem) {
        fmt::print(stderr, "warning: {}\n", problem.what());
    }
}

TextScaleChoice build_text_scale(PreferencesFile& preferences) {
    return {.scale = preferences.now().text_scale.value_or(1),
            .remember = [&preferences](double scale) {
                Preferences chosen = preferences.now();
                chosen.text_scale = scale;
                preferences.keep(chosen);
            }};
}

Existing check_shot(const RunOptions& options) {
    return options.last_shot ? check_output(*options.last_shot, picture_mark, options.overwrites)
                             : Existing::Refuse;
}

// How the file is opened again, where it lies apart from the files that it names.
std::string describe_saved(const fs::path& file) {
    try {
        (void)read_scene(file);
        return file.string();
    } catch (const LoadError&) {
        return fmt::format("{}; it names files in other folders, so open it with 'palpa run {} {}'",
                           file.string(), file.string(), allow_outside);
    }
}

void print_report(const SceneDescription& played, const WindowReport& report) {
    print_summary(played, report.summary);
    fmt::print("  drawn       {} frames, {:.1f} ms median, scale {:.2f} at the end\n",
               report.frames, report.median_frame_ms, report.render_scale);
    if (!played.lesson.empty()) {
        fmt::print("  lesson      {} of {} steps done\n", report.lesson_steps_done,
                   played.lesson.size());
    }
}

}  // namespace

void check_window_options(const RunOptions& options) {
    if (options.record) {
        throw LoadError({"--record"},
                        "a session in a window cannot be recorded yet; expected --headless too");
    }
    if (options.play && options.device && *options.device != "emulated") {
        throw LoadError({"--play"}, "is of the emulated hand; expected it without --device");
    }
    (void)check_shot(options);
}

int open_window(const SceneDescription& scene, const SceneDescription& as_read,
                const Simulation& simulation, EmulatedOmniSettings settings,
                const RunOptions& options) {
    if (!settings.hand) settings.hand = hand_model(Grip::Medium);  // a window needs somebody
    const std::unique_ptr<Device> second = open_second(options.second, options.headless, settings);
    if (!options.play) give_to_mouse(settings);
    PreferencesFile preferences(find_preferences_file());
    WindowDevices devices(settings, preferences, second.get());
    const WindowDevice first =
        devices.open_first(options.play ? std::optional<std::string>("emulated") : options.device);
    if (!devices.notice().empty()) fmt::print(stderr, "warning: {}\n", devices.notice());
    if (preferences.can_keep()) remember_scene(as_read.file, preferences);
    SceneSaver saver(as_read.file, options.screenshots);
    const ViewSettings first_view = first_settings(scene.view, simulation);
    const auto save = [&](const LiveSettings& live, const ViewDescription& view) {
        SceneDescription set = as_read;
        set.coupling = live.coupling;
        set.period_ms = live.period_ms;
        set.view = view;
        return describe_saved(saver.save(set));
    };
    const WindowReport report = run_window(scene, *first.device,
                                           {.view = first_view,
                                            .width = options.width,
                                            .height = options.height,
                                            .grows = !options.has_size,
                                            .screenshots = options.screenshots,
                                            .last_shot = options.last_shot,
                                            .last_shot_existing = check_shot(options),
                                            .last_shot_s = options.last_shot_s,
                                            .orders = first.orders,
                                            .mouse_reach_m = options.play ? 0 : first.mouse_reach_m,
                                            .pads = &devices.pads(),
                                            .devices = options.play ? DeviceMenu() : devices.menu(),
                                            .sound = build_sound_choice(options, preferences),
                                            .text_scale = build_text_scale(preferences),
                                            .save = save,
                                            .notice = devices.notice(),
                                            .lose_device_at = options.lose_device_at,
                                            .validation = options.validation});
    SceneDescription played = scene;
    if (!options.play) played.hand.stroke = Stroke::Path;  // wherever the mouse went
    played.coupling = report.settings.coupling;
    played.period_ms = report.settings.period_ms;
    played.seconds = static_cast<double>(report.summary.ticks) / servo_rate_hz;
    if (options.json) {
        fmt::print("{}", format_summary(played, report.summary));
    } else {
        print_report(played, report);
    }
    return 0;
}

}  // namespace palpa
