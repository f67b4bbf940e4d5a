#include "tools/lab/bench/window.h"

#include "app/run_window.h"
#include "app/window_shell.h"
#include "core/load_error.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "experiments/make_scene.h"
#include "haptics/hand.h"
#include "loading/load.h"
#include "scene/find_scene.h"
#include "scene/read_scene.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

double seconds_since(SteadyClock::time_point begin) {
    return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

// A folder for prepared scenes that is gone at the end.
struct WorkFolder {
    WorkFolder()
        : path(fs::temp_directory_path() /
               fmt::format("palpa-bench-{}", SteadyClock::now().time_since_epoch().count())) {
        fs::create_directories(path);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder() {
        std::error_code error;
        fs::remove_all(path, error);
    }

    fs::path path;
};

fs::path prepare(WindowShell& shell, const fs::path& structure, const fs::path& folder) {
    SceneRequest request{.structure = structure, .force_field = {}};
    request.settings.entry = structure;
    request.settings.solvent.reset();
    MadeScene made;
    const bool is_done =
        shell.work("Preparing " + structure.filename().string(),
                   [&](const StageFunction& on_stage) { made = make_scene(request, on_stage); });
    if (!is_done) throw LoadError({structure.string()}, "was cancelled");
    if (made.scene.files.empty())
        throw LoadError({structure.string()}, "no scene could be made from this structure");
    write_prepared(made.system, folder, made.title, made.scene.files);
    return folder / "scene.toml";
}

// Until the first force of the emulated hand.
void feel(WindowShell& shell, const fs::path& file) {
    const SceneDescription scene = read_scene(file);
    World world;
    EmulatedOmniSettings settings;
    const bool is_loaded = shell.work("Opening " + scene.title, [&](const StageFunction& on_stage) {
        world = load_world(scene, on_stage);
        settings = build_emulated_omni(scene, world);
    });
    if (!is_loaded) throw LoadError({file.string()}, "was cancelled");
    if (!settings.hand) settings.hand = hand_model(HandGrip::Medium);
    EmulatedOmni device(settings);
    WindowOptions options;
    options.view = first_settings(scene.view, world);
    options.is_over = [](const ServoTick& tick) { return !tick.sent_newton.isZero(); };
    (void)run_window(shell, scene, device, options);
}

}  // namespace

void bench_window(const std::vector<fs::path>& files, std::vector<BenchRow>& rows) {
    for (const fs::path& named : files) {
        const std::string name = named.generic_string();
        const SteadyClock::time_point begin = SteadyClock::now();
        const ShellOptions shell_options;
        WindowShell shell(shell_options);
        rows.push_back({name + "/window", {seconds_since(begin)}, "s"});
        const WorkFolder folder;
        fs::path scene = named;
        if (is_structure(named)) {
            scene = prepare(shell, named, folder.path / "scene");
            rows.push_back({name + "/prepared", {seconds_since(begin)}, "s"});
            rows.push_back(
                {name + "/longest pause of the window's thread", {shell.longest_pause_ms()}, "ms"});
        } else {
            scene = find_scene_file(named);
        }
        feel(shell, scene);
        rows.push_back({name + "/first force", {seconds_since(begin)}, "s"});
    }
}

}  // namespace palpa
