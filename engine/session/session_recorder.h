// Holds the journal of a live session from its first moment, so that a recording begun later can be
// played again from there. For one thread at a time.
#pragma once
#include "scene/description.h"
#include "session/journal.h"
#include "session/kept_text.h"
#include "session/live_events.h"
#include "session/recording.h"
#include "session/statistics.h"
#include "session/statistics_file.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

class SessionRecorder {
public:
    // Bytes of a journal that are kept, on disk, for a recording that may come: half an hour or
    // more.
    static constexpr std::size_t most_kept = std::size_t{256} << 20;

    SessionRecorder(const SceneDescription& scene, std::span<const HandDevice> devices);

    // What happened next. A recording that cannot be written any more, as on a full disk, ends; the
    // session is still kept.
    void add(const PlayedEvent& event);
    void add(std::span<const LiveTick> ticks);  // one tick of all hands
    // Why a recording has ended by itself since the last call; empty if none has.
    std::string take_failure() { return std::exchange(failure_, {}); }
    // Marks that part of the session is missing: no recording of it can be played again.
    void lose() noexcept { is_whole_ = false; }

    // Starts a recording: ticks from now on go to the folder's trace. Throws LoadError if a
    // Recording would, or if the beginning of the session is no longer in memory.
    void begin(const std::filesystem::path& folder, bool overwrites,
               const std::optional<TrajectorySettings>& trajectory = {});
    // Adds a frame of the trajectory; does nothing without a recording, or without a trajectory.
    void add(const TrajectoryShot& shot);
    // Notes for the user since the last call, one sentence each.
    std::vector<std::string> take_notes();
    // Ends the recording with its summary, which has the way of what is in hand since the session
    // began; does nothing without one. Throws LoadError if that cannot be written.
    void end(const std::optional<UnbindingPath>& unbinding = {});

    // A row a second of how the session fares from now on, whether it is recorded or not. Throws
    // LoadError where the file is there. What keeps it from being written later is a note.
    void write_statistics(const std::filesystem::path& path, bool overwrites);
    // Of the servo, so far.
    void note_overruns(std::uint64_t overruns) noexcept { overruns_ = overruns; }

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
    void write_beginning(Recording& recording, const std::filesystem::path& folder,
                         const std::optional<TrajectorySettings>& trajectory);
    // Calls `write` with the recording, if there is one, and ends it where that throws LoadError.
    template <class Write>
    void write_to_recording(const Write& write);

    SceneDescription scene_;
    InputNames names_;
    std::vector<KeptFile> files_;
    std::vector<HandDevice> devices_;
    JournalWriter writer_;
    KeptText kept_{most_kept};
    bool is_whole_ = true;  // but for what kept_ could not keep
    std::optional<Recording> recording_;
    std::string failure_;
    std::vector<std::string> notes_;      // of recordings that are over
    std::vector<Statistics> statistics_;  // of what is recorded, of each hand
    std::optional<StatisticsFile> statistics_file_;
    std::uint64_t overruns_ = 0;
};

}  // namespace palpa
