// A scene in a window: with the device, the sound and the scene file that a person chooses.
#pragma once
#include "app/preferences.h"
#include "app/run_window.h"
#include "app/window_shell.h"
#include "devices/emulated_omni.h"
#include "ecs/world.h"
#include "scene/description.h"
#include "tools/commands/run.h"

#include <filesystem>
#include <optional>

namespace palpa {

// Keeps a choice of the window. Throws LoadError.
template <auto Field>
auto remember(PreferencesFile& preferences) {
    return [&preferences](const auto& value) {
        Preferences chosen = preferences.now();
        chosen.*Field = value;
        preferences.keep(chosen);
    };
}

// Checks what can be said of the options before anything is loaded. Throws LoadError.
void check_window_options(const RunOptions& options);

// Sets the folder for what the window saves. Throws LoadError if one is given that is not there.
RunOptions with_files_folder(RunOptions options);

// Of the window that a run opens.
ShellOptions shell_options(const RunOptions& options, PreferencesFile& preferences);

// One scene in the window, which is opened where there is none, after devices. Prints its summary;
// returns what the person goes on to. `world`: as loaded, to plan by; `settings`: of the emulated
// device. Throws LoadError, GpuError.
std::optional<NextScreen> show_scene(std::optional<WindowShell>& shell,
                                     PreferencesFile& preferences, const SceneDescription& scene,
                                     const World& world, EmulatedOmniSettings settings,
                                     const RunOptions& options);

// A recorded session of a window, played again. Throws LoadError, GpuError.
std::optional<NextScreen> show_recording(WindowShell& shell, PreferencesFile& preferences,
                                         const std::filesystem::path& folder,
                                         const RunOptions& options);

// A window for this scene, and for what the person goes on to. Returns the exit code. Throws
// LoadError, PlatformError, GpuError.
int open_window(const SceneDescription& scene, const World& world,
                const EmulatedOmniSettings& settings, const RunOptions& options);

}  // namespace palpa
