// What one sees first: scenes to choose from, one's own files, and the device.
#pragma once
#include "app/run_window.h"
#include "app/scene_cards.h"
#include "app/window_shell.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct StartOptions {
    CardSource cards{};
    std::optional<SceneEntry> before{};              // the scene that was left for this screen
    std::vector<std::filesystem::path> recovered{};  // changed and not saved before a crash
    std::vector<SceneEntry> recent{};                // opened last, the newest first
    std::vector<DeviceOffer> devices{};
    std::string device{};  // the one that is used, of these
    // Chooses another one for the next scene; returns what there is to say of it, and throws
    // LoadError where it cannot be had.
    std::function<std::string(const std::string& name)> choose_device{};
    std::filesystem::path folder{};  // in which a file was looked for last; empty: the current one
    std::function<void(const std::string&)> remember_folder{};  // throws LoadError
    std::string problem{};        // why the last file could not be opened
    std::string said{};           // what was done with the last files
    SoundChoice sound{};          // as it was chosen last
    bool asks_for_sound = false;  // it was never chosen
};

// Until the person chooses; nothing: they quit. Throws GpuError.
std::optional<NextScreen> show_start_screen(WindowShell& shell, const StartOptions& options);

}  // namespace palpa
