#include "tools/commands/open_window.h"

#include "app/recovery.h"
#include "app/replay_session.h"
#include "app/run_window.h"
#include "app/scene_cards.h"
#include "app/window_devices.h"
#include "core/files.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/shell_word.h"
#include "core/translate.h"
#include "experiments/emulated_hand.h"
#include "formats/gzip.h"
#include "haptics/hand.h"
#include "loading/load.h"
#include "render/picture.h"
#include "scene/find_scene.h"
#include "scene/read_scene.h"
#include "session/recording.h"
#include "session/save_scene.h"
#include "tools/commands/kernels.h"
#include "tools/commands/print_run.h"
#include "tools/commands/screens.h"
#include "tools/commands/window_actions.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// Asked for, or else chosen last.
SoundChoice build_sound_choice(const RunOptions& options, PreferencesFile& preferences) {
    return {.is_on = options.sound || preferences.now().sound.value_or(false),
            .remember = remember<&Preferences::sound>(preferences)};
}

std::vector<SceneEntry> list_own_lessons() {
    std::vector<SceneEntry> lessons;
    for (const fs::path& folder : own_scene_folders())
        std::ranges::copy_if(
            list_scenes(folder), std::back_inserter(lessons),
            [](const SceneEntry& scene) { return scene.has_lesson && !scene.is_to_be_made; });
    return order_scenes(std::move(lessons));
}

// Nothing for a scene that came with a picture.
std::function<void(const Picture&)> build_picture_keeper(const fs::path& scene) {
    const fs::path file = find_card_picture(scene);
    if (file.empty() || file.parent_path() == scene.parent_path()) return {};
    return [file](const Picture& picture) {
        make_folder(file.parent_path());
        write_png(file, picture, Existing::Replace);
    };
}

// Takes up a lesson as done, and offers the first one after it that is not.
LessonChoice build_lesson_choice(const fs::path& scene, PreferencesFile& preferences) {
    std::vector<SceneEntry> lessons = list_own_lessons();
    std::error_code error;
    const auto present = std::ranges::find_if(
        lessons, [&](const SceneEntry& entry) { return fs::equivalent(entry.file, scene, error); });
    const std::string name = present == lessons.end()
                                 ? fs::absolute(scene, error).lexically_normal().string()
                                 : present->name;
    if (present != lessons.end()) std::rotate(lessons.begin(), present, lessons.end());
    LessonChoice choice{.remember_done = [name, &preferences](bool /*is_done*/) {
        Preferences chosen = preferences.now();
        if (std::ranges::count(chosen.lessons_done, name) > 0) return;
        chosen.lessons_done.push_back(name);
        preferences.keep(chosen);
    }};
    for (const SceneEntry& other : lessons) {
        if (other.name == name || std::ranges::count(preferences.now().lessons_done, other.name))
            continue;
        choice.next = {other.title, other.file};
        break;
    }
    return choice;
}

// Remembers the scene as opened; a failure keeps nobody from working.
void remember_scene(const fs::path& scene, PreferencesFile& preferences) {
    std::error_code error;
    Preferences chosen = preferences.now();
    chosen.recent =
        add_recent(chosen.recent, fs::absolute(scene, error).lexically_normal().string());
    try {
        preferences.keep(chosen);
    } catch (const LoadError& problem) {
        fmt::print(stderr, "warning: {}\n", problem.what());
    }
}

Existing check_shot(const RunOptions& options) {
    return options.last_shot ? check_output(*options.last_shot, picture_mark, options.overwrites)
                             : Existing::Refuse;
}

// Whether the scene may be read, with files in other folders or without.
bool can_read(const fs::path& file, std::span<const std::string> settings) {
    try {
        (void)read_scene(file, settings);
        return true;
    } catch (const LoadError&) {
        return false;
    }
}

// Says how the file is opened again, where it lies apart from the files that it names.
std::string describe_saved(const fs::path& file) {
    const std::vector<std::string> outside{std::string(allow_outside)};
    if (can_read(file, {}) || !can_read(file, outside)) return file.string();
    return fmt::format(
        "{}; the scene names files in other folders, so open it with 'palpa run {} {}'",
        file.string(), shell_word(file.string()), allow_outside);
}

void print_report(const SceneDescription& played, const WindowReport& report) {
    print_summary(played, report.summary);
    fmt::print("  drawing     {} frames, median {:.1f} ms, scale {:.2f} at the end\n",
               report.frames, report.median_frame_ms, report.render_scale);
    if (!played.lesson.empty()) {
        fmt::print("  lesson      {} of {} steps done\n", report.lesson_steps_done,
                   played.lesson.size());
    }
}

// The message as the window opens; empty if there is none.
std::string find_notice(const SceneDescription& scene, const WindowDevices& devices) {
    if (scene.hands.size() <= 2) return devices.notice();
    return devices.notice() + (devices.notice().empty() ? "" : "\n") +
           translated(
               "This scene has more than two hands; those after the second stand still in a "
               "window.");
}

// The scene as it was played, by the settings that it ended with.
SceneDescription find_played(const SceneDescription& scene, const WindowReport& report,
                             bool is_emulated) {
    SceneDescription played = scene;
    if (!is_emulated) played.hands.front().stroke = Stroke::Path;  // wherever the mouse went
    for (const LiveSettings& settings : report.settings) {
        set_coupling(settings, played);
        played.period_ms = settings.period_ms;
    }
    played.seconds = static_cast<double>(report.summary.ticks) / servo_rate_hz;
    return played;
}

// Opens the device of the second hand; none if the scene has one hand.
WindowDevice open_second_of(const SceneDescription& scene, const World& world,
                            const RunOptions& options, HandOrders& orders, WindowDevices& devices) {
    if (scene.hands.size() < 2) return {};
    EmulatedOmniSettings settings = build_emulated_omni(scene, world, 1);
    if (!settings.hand) settings.hand = hand_model(HandGrip::Medium);
    if (!options.play) give_to_mouse(settings);
    WindowDevice second =
        open_second(options.play ? std::optional<std::string>("emulated") : options.second,
                    settings, orders, devices.pads());
    if (options.play) second.mouse_reach_m = 0;
    return second;
}

}  // namespace

void check_window_options(const RunOptions& options) {
    if (options.record) check_record_folder(*options.record, options.overwrites);
    if (options.record && options.frames_per_second > 0) {
        throw LoadError({"--fps"}, "needs a run without a window; expected --headless with it");
    }
    if (options.play && options.device && *options.device != "emulated") {
        throw LoadError({"--play"}, "belongs to the emulated hand; expected it without --device");
    }
    if (options.serve.waits || options.serve.is_as_fast) {
        throw LoadError({options.serve.waits ? "--serve-wait" : "--serve-fast"},
                        "needs a run without a window; expected --headless with it");
    }
    (void)check_shot(options);
}

ShellOptions shell_options(const RunOptions& options, PreferencesFile& preferences) {
    const Preferences& now = preferences.now();
    return {.width = options.width,
            .height = options.height,
            .has_size = options.has_size,
            .size = {.size = now.window_size,
                     .remember = remember<&Preferences::window_size>(preferences)},
            .text_scale = {.scale = now.text_scale.value_or(1),
                           .remember = remember<&Preferences::text_scale>(preferences)},
            .language = {.code = now.language.value_or(""),
                         .remember = remember<&Preferences::language>(preferences)},
            .theme = {.is_dark = now.dark_theme.value_or(false),
                      .remember = remember<&Preferences::dark_theme>(preferences)},
            .validation = options.validation,
            .files_folder = options.files_folder};
}

std::optional<NextScreen> show_scene(std::optional<WindowShell>& shell,
                                     PreferencesFile& preferences, const SceneDescription& scene,
                                     const World& world, EmulatedOmniSettings settings,
                                     const RunOptions& options) {
    if (!settings.hand) settings.hand = hand_model(HandGrip::Medium);  // a window needs somebody
    if (!options.play) give_to_mouse(settings);
    WindowDevices devices(settings, preferences);
    WindowDevice first, second;
    HandOrders second_orders;
    const auto open_devices = [&] {
        first = devices.open_first(options.play ? std::optional<std::string>("emulated")
                                                : options.device);
        second = open_second_of(scene, world, options, second_orders, devices);
    };
    if (!shell) {  // what is wrong with a device is known before a window opens
        open_devices();
        shell.emplace(shell_options(options, preferences));
    } else if (!shell->work(translated("Opening the device"),
                            [&](const StageFunction& /*on_stage*/) { open_devices(); })) {
        return NextScreen{};
    }
    const std::string news = find_notice(scene, devices);
    if (!news.empty()) fmt::print(stderr, "warning: {}\n", news);
    ServeChoice serve = options.serve;
    serve.options.may_pause = false;  // somebody may have a device in the hand
    const std::unique_ptr<FrameServer> server = open_server(serve, world, !options.json);
    const bool is_from_crash = is_recovered(scene.file);
    if (preferences.can_keep() && !is_from_crash) remember_scene(scene.file, preferences);
    SceneSaver saver(is_from_crash ? options.files_folder / "recovered.toml" : scene.file,
                     options.files_folder);
    const ViewSettings first_view = first_settings(scene.view, world);
    RecoveryFile recovery;
    const auto save = [&](const World& now, const ViewDescription& view) {
        std::string where = describe_saved(saver.save(now, view));
        recovery.forget();
        if (is_from_crash) forget_recovered(scene.file);
        return where;
    };
    std::optional<ActionFile> actions;
    if (options.actions) actions.emplace(*options.actions, options.overwrites);
    const auto start = std::chrono::steady_clock::now();
    const auto note_action = [&](const Action& action, By by) {
        const std::chrono::duration<double> since = std::chrono::steady_clock::now() - start;
        if (actions) actions->add(since.count(), action, by);
    };
    const WindowReport report = run_window(
        *shell, scene, *first.device,
        {.view = first_view,
         .files_folder = options.files_folder,
         .last_shot = options.last_shot,
         .last_shot_existing = check_shot(options),
         .last_shot_s = options.last_shot_s,
         .orders = first.orders,
         .mouse_reach_m = options.play ? 0 : first.mouse_reach_m,
         .second = {second.device.get(), second.orders, second.mouse_reach_m},
         .record = options.record,
         .statistics = options.statistics,
         .overwrites = options.overwrites,
         .trajectory = trajectory_settings(options, !scene.engine),
         .playback = playback_choice(options),
         .pads = &devices.pads(),
         .devices = options.play ? DeviceMenu() : devices.menu(),
         .sound = build_sound_choice(options, preferences),
         .lesson =
             scene.lesson.empty() ? LessonChoice() : build_lesson_choice(scene.file, preferences),
         .is_hand_explained = preferences.now().hand_explained,
         .remember_hand_explained = remember<&Preferences::hand_explained>(preferences),
         .panels = preferences.now().panels,
         .remember_panels = remember<&Preferences::panels>(preferences),
         .save = save,
         .keep_picture = build_picture_keeper(scene.file),
         .save_for_crash = [&](const World& now,
                               const ViewDescription& view) { recovery.save(now, view); },
         .notice = news,
         .server = server.get(),
         .lose_device_at = options.lose_device_at,
         .note_action = note_action});
    std::optional<NextScreen> next = report.next;
    if (next) next->left = scene.file;
    if (report.frames == 0 && next) return next;  // it was not loaded
    if (noted_interrupt() == 0) recovery.forget();
    const SceneDescription played = find_played(scene, report, options.play);
    if (options.json) {
        fmt::print("{}", format_summary(played, report.summary));
    } else {
        print_report(played, report);
    }
    return next;
}

std::optional<NextScreen> show_recording(WindowShell& shell, PreferencesFile& preferences,
                                         const fs::path& folder, const RunOptions& options) {
    const SceneDescription scene = read_recorded_scene(folder);
    if (!has_journal(folder)) {
        throw LoadError({folder.string()},
                        "has no journal, so it was recorded without a window; 'palpa replay FOLDER "
                        "--verify' plays it");
    }
    const RecordedKernels kernels(folder);
    RecordedDevice first({.name = "recorded session"}), second({.name = "recorded session"});
    if (preferences.can_keep())
        remember_scene(find_plain_or_packed(folder / journal_name), preferences);
    ViewSettings view;
    const bool is_loaded = shell.work(
        format_translated("Opening {}", scene.title), [&](const StageFunction& on_stage) {
            view = first_settings(scene.view, load_world(scene, on_stage));
        });
    if (!is_loaded) return NextScreen{};
    const WindowReport report =
        run_window(shell, scene, first,
                   {.view = view,
                    .files_folder = options.files_folder,
                    .last_shot = options.last_shot,
                    .last_shot_existing = check_shot(options),
                    .last_shot_s = options.last_shot_s,
                    .second = {scene.hands.size() > 1 ? &second : nullptr},
                    .replay = folder,
                    .sound = build_sound_choice(options, preferences),
                    .panels = preferences.now().panels,
                    .remember_panels = remember<&Preferences::panels>(preferences)});
    if (report.replay) {
        fmt::print("{}: played {:.2f} of {:.2f} s\n  {}\n", folder.string(), report.replay->at_s,
                   report.replay->length_s, report.replay->verdict);
    }
    std::optional<NextScreen> next = report.next;
    if (next) next->left = find_plain_or_packed(folder / journal_name);
    return next;
}

RunOptions with_files_folder(RunOptions options) {
    std::error_code error;
    if (options.files_folder.empty())
        options.files_folder = find_files_folder();
    else if (!fs::is_directory(options.files_folder, error))
        throw LoadError({options.files_folder.string()},
                        "is not a folder; expected the folder for what the window saves");
    return options;
}

int open_window(const SceneDescription& scene, const World& world,
                const EmulatedOmniSettings& settings, const RunOptions& given) {
    const RunOptions options = with_files_folder(given);
    PreferencesFile preferences(find_preferences_file());
    std::optional<WindowShell> shell;
    follow_screens(shell, preferences, options,
                   show_scene(shell, preferences, scene, world, settings, options));
    return 0;
}

}  // namespace palpa
