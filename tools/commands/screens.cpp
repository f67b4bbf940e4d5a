#include "tools/commands/screens.h"

#include "app/fetch_structure.h"
#include "app/open_structure.h"
#include "app/preferences.h"
#include "app/recovery.h"
#include "app/start_screen.h"
#include "app/window_devices.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "devices/open_device.h"
#include "experiments/emulated_hand.h"
#include "loading/load.h"
#include "prepare/report.h"
#include "scene/find_scene.h"
#include "scene/read_scene.h"
#include "session/recording.h"
#include "tools/commands/open_window.h"

#include <fmt/format.h>
#include <algorithm>
#include <span>
#include <string>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// Of later scenes in the same window; most options are the first scene's alone.
RunOptions options_of_later(const RunOptions& first) {
    RunOptions later;
    later.device = first.device;
    later.second = first.second;
    later.sound = first.sound;
    later.files_folder = first.files_folder;
    later.json = first.json;
    return later;
}

// What is missing of a device that was chosen, which is taken as soon as it is there.
std::string choose_device(const std::string& name, PreferencesFile& preferences) {
    const DeviceMaker& maker = device_maker_called(name);
    OpenedDevice opened;
    if (!maker.is_emulated && !maker.needs_window) {
        const DeviceRequest request;
        opened = maker.open(request);
    }
    Preferences chosen = preferences.now();
    chosen.device = name;
    preferences.keep(chosen);
    if (opened.device) return format_translated("{} is ready.", opened.device->spec().name);
    for (const DeviceCheck& check : opened.checks) {
        if (check.outcome == CheckOutcome::Failed)
            return format_translated("{}: {}; {}. Until then the mouse is used.", check.layer,
                                     check.found, check.remedy);
    }
    return {};
}

fs::path prepared_folder(const RunOptions& options) {
    return find_prepared_folder().value_or(options.files_folder);
}

bool is_below(const fs::path& file, const fs::path& folder) {
    const fs::path relative = file.lexically_relative(folder);
    return !relative.empty() && *relative.begin() != "..";
}

// The person's scenes: those opened last, then what was prepared.
std::vector<SceneEntry> list_yours(std::span<const SceneEntry> recent, const fs::path& prepared) {
    std::vector<SceneEntry> yours;
    const std::vector<fs::path> own = own_scene_folders();
    const auto add = [&](const SceneEntry& entry) {
        const bool is_own = std::ranges::any_of(
            own, [&](const fs::path& folder) { return is_below(entry.file, folder); });
        const bool is_known = std::ranges::count(yours, entry.file, &SceneEntry::file) > 0;
        if (entry.file.extension() == ".toml" && !is_own && !is_known) yours.push_back(entry);
    };
    for (const SceneEntry& entry : recent) add(entry);
    for (const SceneEntry& entry : list_scenes(prepared)) add(describe_file(entry.file));
    return yours;
}

// `before`: the scene that was left; empty: there was none.
StartOptions build_start(PreferencesFile& preferences, const RunOptions& options,
                         const NextScreen& wanted, const fs::path& before) {
    const DeviceRequest request;
    const Preferences& now = preferences.now();
    StartOptions start{
        .devices = list_device_offers(request),
        .device = options.device.value_or(now.device.value_or(first_device)),
        .choose_device =
            [&preferences](const std::string& name) { return choose_device(name, preferences); },
        .folder = now.folder.value_or(""),
        .remember_folder = remember<&Preferences::folder>(preferences),
        .problem = wanted.problem,
        .said = wanted.said,
        .sound = {.is_on = now.sound.value_or(false),
                  .remember = remember<&Preferences::sound>(preferences)},
        .asks_for_sound = !now.sound && preferences.can_keep()};
    if (!before.empty()) start.before = describe_file(before);
    for (const fs::path& folder : own_scene_folders())
        std::ranges::move(list_scenes(folder), std::back_inserter(start.cards.scenes));
    start.recovered = list_recovered();
    for (const std::string& file : now.recent) {
        std::error_code error;
        if (fs::exists(file, error)) start.recent.push_back(describe_file(file));
    }
    start.cards.yours = list_yours(start.recent, prepared_folder(options));
    start.cards.lessons_done = now.lessons_done;
    return start;
}

void refuse_other_file(const fs::path& file) {
    std::error_code error;
    if (fs::is_regular_file(file, error) && !can_be_opened(file))
        throw LoadError({file.string()},
                        fmt::format("is neither a scene nor a structure; expected {}, also .gz",
                                    fmt::join(list_endings(), ", ")));
}

void refuse_scene_among(const std::vector<fs::path>& files) {
    for (const fs::path& file : files) {
        if (files.size() > 1 && file.extension() == ".toml")
            throw LoadError({file.string()}, "is a scene; expected it alone, without other files");
    }
}

// Nothing where the person changed their mind.
std::optional<fs::path> find_scene_of(WindowShell& shell, const std::vector<fs::path>& files,
                                      const RunOptions& options, const std::string& said) {
    if (files.size() == 1 && !is_structure(files[0]) && !is_topology(files[0]))
        return find_scene_file(files[0]);
    return open_structure(shell, files, prepared_folder(options), said);
}

// The folder of a window's recording that the files are, if they are one.
std::optional<fs::path> find_recording(const std::vector<fs::path>& files) {
    if (files.size() != 1) return std::nullopt;
    std::error_code error;
    if (fs::is_directory(files[0], error) && has_journal(files[0])) return files[0];
    if (!is_journal(files[0])) return std::nullopt;
    return fs::absolute(files[0], error).parent_path();
}

std::optional<NextScreen> show_files(std::optional<WindowShell>& shell,
                                     PreferencesFile& preferences,
                                     const std::vector<fs::path>& files, RunOptions options,
                                     const std::string& said = {}) {
    if (const std::optional<fs::path> folder = find_recording(files))
        return show_recording(*shell, preferences, *folder, options);
    if (files.size() == 1) refuse_other_file(files[0]);
    refuse_scene_among(files);
    if (const auto groups = split_structures(files); groups.size() > 1) {
        PreparedEach each = prepare_each(*shell, groups, prepared_folder(options));
        return NextScreen{.said = std::move(each.said), .problem = std::move(each.problem)};
    }
    const std::optional<fs::path> file = find_scene_of(*shell, files, options, said);
    if (!file) return NextScreen{};
    options.scene = *file;
    std::vector<std::string> settings_over;
    if (is_recovered(*file)) settings_over.emplace_back(allow_outside);
    const SceneDescription scene = read_scene(*file, settings_over);
    World world;
    EmulatedOmniSettings settings;
    const bool is_loaded = shell->work(format_translated("Opening {}", scene.title),
                                       [&](const StageFunction& on_stage) {
                                           world = load_world(scene, on_stage);
                                           settings = build_emulated_omni(scene, world);
                                       });
    if (!is_loaded) return NextScreen{};
    return show_scene(shell, preferences, scene, world, settings, options);
}

// Downloads the entry first, if there is one.
std::optional<NextScreen> show_named(std::optional<WindowShell>& shell,
                                     PreferencesFile& preferences, const NextScreen& named,
                                     const RunOptions& options) {
    if (named.code.empty()) return show_files(shell, preferences, named.files, options);
    const std::optional<FetchedEntry> entry = fetch_structure(*shell, preferences, named.code);
    if (!entry) return NextScreen{};
    fmt::print(stderr, "note: {}\n", printable(describe(*entry)));
    std::vector<fs::path> files{entry->file};
    files.insert(files.end(), named.files.begin(), named.files.end());
    return show_files(shell, preferences, files, options, translated_description(*entry));
}

}  // namespace

void follow_screens(std::optional<WindowShell>& shell, PreferencesFile& preferences,
                    const RunOptions& options, std::optional<NextScreen> next) {
    RunOptions later = options_of_later(options);
    const std::optional<std::string> device = preferences.now().device;
    fs::path left;  // the scene that was shown last
    while (next) {
        if (!next->left.empty()) left = next->left;
        // What a person chose in the window counts more than the command line.
        if (preferences.now().device != device) later.device.reset();
        if (next->is_start()) {
            next = show_start_screen(*shell, build_start(preferences, later, *next, left));
            continue;
        }
        try {
            next = show_named(shell, preferences, *next, later);
        } catch (const LoadError& error) {
            next = NextScreen{.problem = without_options(error.what())};
        }
    }
}

int open_screens(const NextScreen& first, const RunOptions& given) {
    const RunOptions options = with_files_folder(given);
    PreferencesFile preferences(find_preferences_file());
    std::optional<WindowShell> shell;
    shell.emplace(shell_options(options, preferences));
    follow_screens(shell, preferences, options, first);
    return exit_code_after(0);
}

}  // namespace palpa
