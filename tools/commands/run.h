// palpa run: a scene in a window, or headless under the emulated hand.
#pragma once
#include "scene/description.h"
#include "session/trajectory_recorder.h"
#include "simulation/playback.h"
#include "tools/commands/serve.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct RunOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file
    std::optional<std::filesystem::path> record;
    std::optional<std::filesystem::path> statistics;  // file
    bool overwrites = false;       // an earlier recording, statistics, or picture of --shot
    double frames_per_second = 0;  // 0: no frames in the recording
    std::uint32_t frame_width = 640, frame_height = 360;
    std::optional<double> trajectory_fps;  // frames a simulated second; nothing: as usual
    bool trajectory_xtc = false;           // as XTC too
    bool compresses = false;               // the recording of a run without a window
    std::optional<std::filesystem::path> trajectory;  // of another program, to be played
    double trajectory_speed = 25;                     // frames a second; 0: paused
    std::size_t trajectory_frame = 1;                 // the first that is shown, from 1
    bool check_only = false;
    bool json = false;  // the summary as JSON on standard output
    bool headless = false;
    std::optional<std::string> device;  // one of the list in devices/open_device.h
    std::optional<std::string> second;  // the same, of the scene's second hand
    bool sound = false;                 // in a window: the felt force as a tone, from the beginning
    bool play = false;  // in a window: the emulated hand plays the scene's stroke, no mouse
    std::uint32_t width = 1280, height = 800;      // of the window
    bool has_size = false;                         // they were asked for
    std::filesystem::path files_folder{};          // of what the window saves; empty: the documents
    std::optional<std::filesystem::path> actions;  // file for what a person does in the window
    std::optional<std::filesystem::path> last_shot;  // of the window, which then closes
    double last_shot_s = 5;
    std::uint64_t lose_device_at = 0;
    bool validation = false;  // of all calls of Vulkan
    bool commands = false;    // standard input drives the run (scene/run_commands.h)
    ServeChoice serve;
};

// Settings of a run's recordings. `can_be_replayed`: the recording's journal has all that moves the
// atoms, so that a replay makes the trajectory, which is written only on request.
TrajectorySettings trajectory_settings(const RunOptions& options, bool can_be_replayed = false);

// Of another program, to be played.
std::optional<PlaybackChoice> playback_choice(const RunOptions& options);

// Throws LoadError on bad input. Returns the exit code.
int run_command(const RunOptions& options);
// The same of a scene that was read.
int run_scene(const SceneDescription& scene, const RunOptions& options);

// Where a remote engine does not answer, or was lost for good.
inline constexpr int engine_lost = 4;

}  // namespace palpa
