// The sandbox in a window: draws a running scene, and lets a person take part.
#pragma once
#include "haptics/device.h"
#include "haptics/hand.h"
#include "scene/description.h"
#include "session/commands.h"
#include "session/statistics.h"
#include "session/study_course.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace palpa {

struct WindowOptions {
    ViewSettings view{};
    std::uint32_t width = 1280, height = 800;
    std::filesystem::path screenshots{"."};            // folder
    std::optional<std::filesystem::path> last_shot{};  // taken after `last_shot_s`, then it quits
    double last_shot_s = 5;
    HandOrders* orders = nullptr;  // of an emulated device's hand
    double mouse_reach_m = 0;      // how far ahead of the handle a mouse's hand goes; 0: no mouse
    double most_frames_per_s = 60;
    std::uint64_t lose_device_at = 0;  // frame at which the graphics device is given up, for tests
    StudyCourse* study = nullptr;      // the window is for this alone: no overlays, one key
    std::function<void()> on_trial{};  // after each
    bool validation = false;  // of all that Vulkan is told; what it finds is thrown at the end
};

struct WindowReport {
    Summary summary;
    LiveSettings settings;  // as the person left them
    std::uint64_t frames = 0;
    double median_frame_ms = 0;
    double render_scale = 1;  // at the end
    std::size_t lesson_steps_done = 0;
};

// Runs until the person quits. Throws PlatformError without a display, GpuError, LoadError.
WindowReport run_window(const SceneDescription& scene, Device& device,
                        const WindowOptions& options);

}  // namespace palpa
