// A scene that runs behind a window: live, or a recorded session that is played again.
#pragma once
#include "app/live_frame.h"
#include "app/recording_meter.h"
#include "ecs/world.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "haptics/servo.h"
#include "session/commands.h"
#include "session/trajectory_recorder.h"
#include "session/unbinding_path.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Runs on threads of its own. One thread, the window's, calls these.
class WindowSession {
public:
    WindowSession() = default;
    WindowSession(const WindowSession&) = delete;
    WindowSession& operator=(const WindowSession&) = delete;
    virtual ~WindowSession() = default;

    virtual void send(const Command& command) = 0;

    // The newest frame; asks for the next one. False if none came since the last call.
    virtual bool read_frame(LiveFrame& frame) = 0;

    // The world between two steps; waits for the one that is under way.
    virtual World copy_world() = 0;  // without the caches of its mechanics

    // Every servo tick in its order, as long as somebody takes them out: of all hands, by slot.
    virtual bool pop_ticks(std::span<ServoTick> ticks) noexcept = 0;

    virtual ServoHealth servo_health() const noexcept { return {}; }

    // Sets the target of the handle (m) of a live hand, and whether the hand presses the clutch.
    virtual void move_hand(const Vec3& /*target_m*/, std::size_t /*slot*/, bool /*is_clutched*/) {}

    // Returns the path of the first hand's molecule; nothing if no molecule moves by itself.
    virtual std::optional<UnbindingPath> find_unbinding() { return {}; }

    // Puts another device in a hand's place; the one before is the caller's again. Throws
    // LoadError, and changes nothing, where that one cannot be run here.
    virtual void change_device(Device& device, HandOrders* orders, std::size_t slot) = 0;

    // What a server of other programs has to say since the last call.
    virtual std::vector<std::string> take_server_notes() { return {}; }

    // Records from now on into the folder. Throws LoadError where a Recording would, and where
    // something is recorded already.
    virtual void begin_recording(const std::filesystem::path& folder, bool overwrites,
                                 const std::optional<TrajectorySettings>& trajectory) = 0;
    // Another thread then compresses what was recorded. Throws LoadError where not all could be
    // written.
    virtual void end_recording() {}
    // Nothing where nothing is recorded.
    virtual std::optional<RecordingState> recording() { return {}; }
    // Share of the compression that is done; nothing where nothing is compressed.
    virtual std::optional<double> packed_share() { return {}; }
    // Recordings that were compressed, or could not be, since the last call.
    virtual std::vector<EndedRecording> take_ended() { return {}; }
    // Leaves as it is what is not compressed yet.
    virtual void stop_packing() {}
    // What a user should know of the recording, a sentence each, since the last call.
    virtual std::vector<std::string> take_recording_notes() { return {}; }
};

}  // namespace palpa
