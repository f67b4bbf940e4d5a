// What one sees first: scenes to choose from, one's own files, and the device.
#pragma once
#include "app/run_window.h"
#include "app/window_shell.h"
#include "scene/find_scene.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct StartOptions {
    std::vector<SceneEntry> scenes{};  // those with a level are shown as cards, with their pictures
    std::vector<std::filesystem::path> recovered{};  // changed and not saved before a crash
    std::vector<std::filesystem::path> recent{};     // opened last, the newest first
    std::vector<DeviceOffer> devices{};
    std::string device{};  // the one that is used, of these
    // Chooses another one for the next scene; returns what there is to say of it, and throws
    // LoadError where it cannot be had.
    std::function<std::string(const std::string& name)> choose_device{};
    std::string problem{};  // why the last file could not be opened
};

// Until the person chooses; nothing: they quit. Throws GpuError.
std::optional<NextScreen> show_start_screen(WindowShell& shell, const StartOptions& options);

}  // namespace palpa
