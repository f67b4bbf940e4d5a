// The sandbox in a window: draws a running scene, and lets a person take part.
#pragma once
#include "core/files.h"
#include "experiments/study_course.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "scene/description.h"
#include "session/commands.h"
#include "session/statistics.h"
#include "session/trajectory_recorder.h"
#include "ui/overlay.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

class FrameServer;

// A device in the hand's place.
struct WindowDevice {
    std::unique_ptr<Device> device;
    HandOrders* orders = nullptr;  // of one that can stand still
    double mouse_reach_m = 0;      // how far ahead of its handle a mouse may be; 0: none leads it
};

// The same of somebody else's, which outlives the window.
struct LedDevice {
    Device* device = nullptr;  // null: there is none
    HandOrders* orders = nullptr;
    double mouse_reach_m = 0;
};

// From what a person may choose. None where `open` is empty.
struct DeviceMenu {
    std::vector<DeviceOffer> offers{};
    std::string current{};  // the one that the window begins with
    std::string wanted{};   // to be taken as soon as it is there; empty: none
    std::function<bool(const std::string& name)> is_there{};      // a quick look
    std::function<WindowDevice(const std::string& name)> open{};  // throws LoadError
    std::function<void(const std::string& name)> remember{};      // throws LoadError
};

// The felt force as a tone.
struct SoundChoice {
    bool is_on = false;                    // to begin with
    std::function<void(bool)> remember{};  // what the person switched it to; throws LoadError
};

// The size of the window's text, over what the display asks for.
struct TextScaleChoice {
    double scale = 1;                        // to begin with
    std::function<void(double)> remember{};  // what the person chose; throws LoadError
};

struct WindowOptions {
    ViewSettings view{};
    std::uint32_t width = 1280, height = 800;
    bool grows = true;  // with the display's scale: nobody asked for that size in pixels
    std::filesystem::path screenshots{"."};            // folder
    std::optional<std::filesystem::path> last_shot{};  // taken after `last_shot_s`, then it quits
    Existing last_shot_existing = Existing::Refuse;
    double last_shot_s = 5;
    HandOrders* orders = nullptr;                   // of an emulated device's hand
    double mouse_reach_m = 0;                       // as of WindowDevice
    LedDevice second{};                             // in the scene's second hand, where it has one
    std::optional<std::filesystem::path> record{};  // folder, from the first moment on
    bool overwrites = false;                        // a recording in it
    TrajectorySettings trajectory{};                // of recordings
    std::optional<PlaybackChoice> playback{};       // a trajectory to play
    PadLink* pads = nullptr;                        // where game pads are posted
    DeviceMenu devices{};
    SoundChoice sound{};
    TextScaleChoice text_scale{};
    // Writes the scene with these settings, shown so, and says where; throws LoadError. Empty:
    // cannot.
    std::function<std::string(const LiveSettings&, const ViewDescription&)> save{};
    std::string notice{};           // to begin with
    FrameServer* server = nullptr;  // of the simulation's thread meanwhile
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
