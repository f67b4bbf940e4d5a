// The sandbox in a window: draws a running scene, and lets a person take part.
#pragma once
#include "app/actions.h"
#include "core/files.h"
#include "ecs/world.h"
#include "experiments/study_course.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "haptics/servo.h"
#include "render/picture.h"
#include "scene/description.h"
#include "session/commands.h"
#include "session/statistics.h"
#include "session/trajectory_recorder.h"
#include "view/build_frame.h"

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

// A device that can be chosen.
struct DeviceOffer {
    std::string name, summary;  // name for --device; short description
    bool is_there = true;       // as far as it can be detected
    bool is_stand_in =
        false;  // a substitute for hardware: used only on request, and never remembered
};

// The device of a hand in the window.
struct WindowDevice {
    std::unique_ptr<Device> device;
    HandOrders* orders = nullptr;  // null if the device cannot be stopped
    double mouse_reach_m =
        0;  // largest distance of the mouse target from the handle, m; 0: not moved by the mouse
};

// The same for a device owned by the caller, which outlives the window.
struct LedDevice {
    Device* device = nullptr;  // null: there is none
    HandOrders* orders = nullptr;
    double mouse_reach_m = 0;
};

// Devices to choose from. None if `open` is empty.
struct DeviceMenu {
    std::vector<DeviceOffer> offers{};
    std::string current{};  // device at the start
    std::string wanted{};   // device to use as soon as it is connected; empty: none
    std::function<bool(const std::string& name)> is_there{};      // quick check for a connection
    std::function<WindowDevice(const std::string& name)> open{};  // throws LoadError
    std::function<void(const std::string& name)> remember{};      // throws LoadError
};

// The setting of the force as a tone.
struct SoundChoice {
    bool is_on = false;                    // state at the start
    std::function<void(bool)> remember{};  // saves the person's choice; throws LoadError
};

// The lesson after this one.
struct NextLesson {
    std::string title;
    std::filesystem::path file;
};

struct LessonChoice {
    std::optional<NextLesson> next{};           // none: every other lesson is done
    std::function<void(bool)> remember_done{};  // saves that this one is done; throws LoadError
};

struct WindowOptions {
    ViewSettings view{};
    std::filesystem::path files_folder{"."};  // of what is saved; made when it is needed
    std::optional<std::filesystem::path>
        last_shot{};  // file of a screenshot after `last_shot_s`; then the window closes
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
    LessonChoice lesson{};  // of a scene with a lesson
    // Whether the signs of the hand (ring, thread, bar) were explained before; saves that they
    // were.
    bool is_hand_explained = false;
    std::function<void(bool)> remember_hand_explained{};  // throws LoadError
    // How a person left the panels (list_docks), and what saves that; throws LoadError.
    std::vector<std::string> panels{};
    std::function<void(const std::vector<std::string>&)> remember_panels{};
    // Saves the world with this view as a scene, and returns where; throws LoadError. Empty: saving
    // is not possible.
    std::function<std::string(const World&, const ViewDescription&)> save{};
    // Keeps a small picture of the scene as it was left, for the start screen; throws LoadError.
    // Empty: the scene has one.
    std::function<void(const Picture&)> keep_picture{};
    // The same for crash recovery, without a message. Empty: not done.
    std::function<void(const World&, const ViewDescription&)> save_for_crash{};
    std::string notice{};           // shown at the start
    FrameServer* server = nullptr;  // used by the simulation's thread meanwhile
    double most_frames_per_s = 60;
    std::uint64_t lose_device_at = 0;  // frame at which the graphics device is given up, for tests
    StudyCourse* study = nullptr;      // shows only this study: no overlays, one key
    std::function<void()> on_trial{};  // called after each trial
    // Called for each action that a person does. Empty: never.
    std::function<void(const Action&, By)> note_action{};
    // Called for each tick of the first hand; the window closes when it returns true. Empty: never.
    std::function<bool(const ServoTick&)> is_over{};
};

// What the person opens after a scene.
struct NextScreen {
    std::vector<std::filesystem::path> files{};  // files to open
    // PDB entry to download and open, with the files; neither: the start screen.
    std::string code{};
    std::filesystem::path left{};   // the scene before
    std::string said{}, problem{};  // on the start screen: what was done; what was not, and why

    bool is_start() const noexcept { return files.empty() && code.empty(); }
};

struct WindowReport {
    Summary summary;
    std::vector<LiveSettings> settings;  // of each hand, at the end
    std::uint64_t frames = 0;
    double median_frame_ms = 0;
    double render_scale = 1;  // render scale at the end
    std::size_t lesson_steps_done = 0;
    std::optional<NextScreen> next{};     // nothing: they quit
    std::optional<ReplayState> replay{};  // of a recorded session, as far as it was played
};

// Loads the scene and shows it in the shell's window until the person leaves it. Throws GpuError
// and LoadError. If loading is cancelled, the report contains only the next screen.
WindowReport run_window(WindowShell& shell, const SceneDescription& scene, Device& device,
                        const WindowOptions& options);

}  // namespace palpa
