// The sandbox in a window: draws a running scene, and lets a person take part.
#pragma once
#include "core/files.h"
#include "experiments/study_course.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "haptics/servo.h"
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
class WindowShell;

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

// A scene as a person changed it.
struct SceneState {
    LiveSettings settings;
    ViewDescription view;
    std::vector<EditDescription> edits{};  // from the scene's beginning on
};

struct WindowOptions {
    ViewSettings view{};
    std::filesystem::path screenshots{"."};            // folder
    std::optional<std::filesystem::path> last_shot{};  // taken after `last_shot_s`, then it quits
    Existing last_shot_existing = Existing::Refuse;
    double last_shot_s = 5;
    HandOrders* orders = nullptr;                   // of an emulated device's hand
    double mouse_reach_m = 0;                       // as of WindowDevice
    LedDevice second{};                             // in the scene's second hand, where it has one
    std::optional<std::filesystem::path> record{};  // folder, from the first moment on
    std::optional<std::filesystem::path> statistics{};  // file, a row a second
    bool overwrites = false;                            // a recording, and statistics
    TrajectorySettings trajectory{};                    // of recordings
    std::optional<PlaybackChoice> playback{};           // a trajectory to play
    // The folder of a recorded session of this scene, which is played again: nobody takes part.
    std::optional<std::filesystem::path> replay{};
    PadLink* pads = nullptr;  // where game pads are posted
    DeviceMenu devices{};
    SoundChoice sound{};
    // Writes the scene with these settings, shown so, and changed so, and says where; throws
    // LoadError. Empty: cannot.
    std::function<std::string(const SceneState&)> save{};
    // The same where nobody asked, for a crash; without a word of where. Empty: it does not.
    std::function<void(const SceneState&)> save_for_crash{};
    std::string notice{};           // to begin with
    FrameServer* server = nullptr;  // of the simulation's thread meanwhile
    double most_frames_per_s = 60;
    std::uint64_t lose_device_at = 0;  // frame at which the graphics device is given up, for tests
    StudyCourse* study = nullptr;      // the window is for this alone: no overlays, one key
    std::function<void()> on_trial{};  // after each
    // Of each tick of the first hand: the window ends where it says so; empty: it never does.
    std::function<bool(const ServoTick&)> is_over{};
};

// What the person wants to see after a scene.
struct NextScreen {
    std::vector<std::filesystem::path> files{};  // to open; none: the start screen
};

struct WindowReport {
    Summary summary;
    LiveSettings settings;  // as the person left them
    std::uint64_t frames = 0;
    double median_frame_ms = 0;
    double render_scale = 1;  // at the end
    std::size_t lesson_steps_done = 0;
    std::optional<NextScreen> next{};     // nothing: they quit
    std::optional<ReplayState> replay{};  // of a recorded session, as far as it was played
};

// Loads the scene and shows it in the shell's window until the person leaves it. Throws GpuError,
// LoadError. Where loading is cancelled the report has a next screen and nothing else.
WindowReport run_window(WindowShell& shell, const SceneDescription& scene, Device& device,
                        const WindowOptions& options);

}  // namespace palpa
