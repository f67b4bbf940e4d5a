// Holds the journal of a live session from its first moment, so that a recording begun later can be
// played again from there. For one thread at a time.
#pragma once
#include "scene/description.h"
#include "session/journal.h"
#include "session/live_events.h"
#include "session/recording.h"
#include "session/statistics.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

class SessionRecorder {
public:
    // Largest journal, bytes, that is held in memory for a later recording: an hour or more.
    static constexpr std::size_t most_kept = std::size_t{256} << 20;

    SessionRecorder(const SceneDescription& scene, std::span<const HandDevice> devices);

    void add(const PlayedEvent& event);
    void add(std::span<const LiveTick> ticks);  // one tick of all hands
    // Marks that part of the session is missing: no recording of it can be played again.
    void lose() noexcept { is_whole_ = false; }

    // Starts a recording: ticks from now on go to the folder's trace. Throws LoadError if a
    // Recording would, or if the beginning of the session is no longer in memory.
    void begin(const std::filesystem::path& folder, bool overwrites,
               const std::optional<TrajectorySettings>& trajectory = {});
    // Adds a frame of the trajectory; does nothing without a recording.
    void add(const TrajectoryShot& shot);
    // Notes for the user since the last call, one sentence each.
    std::vector<std::string> take_notes();
    // Stops recording without a summary.
    void give_up() noexcept { recording_.reset(); }
    // Ends the recording with its summary; does nothing without one. Throws LoadError if it cannot
    // be written.
    void end();

    bool is_recording() const noexcept { return recording_.has_value(); }
    double recorded_s() const noexcept;

private:
    // A file of an edit.
    struct KeptFile {
        std::filesystem::path path;
        std::string name, content;  // `name`: in a recording
    };

    const std::string& keep(const std::filesystem::path& path, const std::string& content);
    void flush();

    SceneDescription scene_;
    InputNames names_;
    std::vector<KeptFile> files_;
    std::vector<HandDevice> devices_;
    JournalWriter writer_;
    std::string kept_;
    bool is_whole_ = true;
    std::optional<Recording> recording_;
    std::vector<std::string> notes_;      // notes of ended recordings
    std::vector<Statistics> statistics_;  // of the recording, for each hand
};

}  // namespace palpa
