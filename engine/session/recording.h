// A session on disk: a folder with trace.csv, summary.json, session.toml and the scene's inputs;
// one from a window has a journal.txt too (session/journal.h), and where asked there is a
// trajectory (session/trajectory_recorder.h).
#pragma once
#include "core/file_versions.h"
#include "core/files.h"
#include "haptics/servo.h"
#include "scene/description.h"
#include "session/statistics.h"
#include "session/trajectory_recorder.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// A hash of the scene, every field and the content of every file that it names. 16 hex digits.
std::string scene_hash(const SceneDescription& scene);

// The trace's first line, without its end. One column a value, the unit last in the name. Further
// hands have the columns of the first behind its own, but for time and period, with "_2", "_3", ...
// at the end of the name.
// Where molecules relax, its last columns are the error estimate and the age of the model.
std::string trace_header(std::size_t hands = 1, bool relaxes = false);

// One of its rows, with its end: every number in the shortest form that reads back to the same
// bits. One tick of all hands.
std::string trace_row(std::span<const ServoTick> ticks, bool relaxes = false);
inline std::string trace_row(const ServoTick& tick) { return trace_row({&tick, 1}); }

// The summary as a JSON object; scripts rely on its keys, which the README of tools lists.
std::string format_summary(const SceneDescription& scene, const Summary& summary);

// Throws LoadError where a Recording in the folder would, before anything long is done for it.
void check_record_folder(const std::filesystem::path& folder, bool overwrites);

// What files are called in a recording.
class InputNames {
public:
    // Those of the scene, which have their names.
    explicit InputNames(const SceneDescription& scene);

    // "inputs/NAME" for one more.
    std::string add(const std::filesystem::path& file);

private:
    std::set<std::string> taken_;
};

// What brings a recorded session back: the scene's own hand, or a journal.
// A trajectory that moved the atoms, and the lines of a scripted run, are not in the recording, and
// do not come back.
enum class RecordedBy { Hand, Journal, Trajectory, Commands };

// Whether the folder holds a recording by a trajectory, or of a scripted run.
bool is_of_trajectory(const std::filesystem::path& folder);
bool is_of_commands(const std::filesystem::path& folder);

// Whether it is one of a window: with everything that devices, person and clients did.
bool has_journal(const std::filesystem::path& folder);

// The version of the recording in a folder, which its session.toml states; of one without a number
// that of version 1.
FileVersion read_recording_version(const std::filesystem::path& folder);

// The scene of a recording that can be played again. Throws LoadError where the folder holds none
// or one of a newer major version, and where something that is not in it moved the atoms: a remote
// engine, a trajectory, commands.
SceneDescription read_recorded_scene(const std::filesystem::path& folder);

class Recording {
public:
    // Makes the folder and writes session.toml and the inputs: what is needed to run the session
    // again is there from the first moment. Throws LoadError if the folder cannot be written, if
    // another run records into it, or if it is not empty. A recording in it is replaced if
    // `overwrites`: the files that belong to one, and nothing else.
    Recording(const std::filesystem::path& folder, const SceneDescription& scene,
              bool overwrites = false, std::size_t hands = 1, RecordedBy by = RecordedBy::Hand);

    // Every `every`th tick of all hands becomes a row. What was written stays readable if the run
    // is cut off.
    void add(std::span<const ServoTick> ticks);
    void add(const ServoTick& tick) { add({&tick, 1}); }

    // Of a recording by journal: what follows in journal.txt.
    void add_journal(const std::string& text);

    // One more input, that was read while the session ran. `name`: of InputNames. Throws LoadError
    // where it cannot be written.
    void add_input(const std::string& name, const std::string& content);

    // A trajectory beside the trace, from its first frame on. What keeps it from being written is
    // a note.
    void begin_trajectory(const TrajectorySettings& settings);
    void add_frame(const TrajectoryShot& shot);
    // What a user should know of it, a sentence each, since the last call.
    std::vector<std::string> take_notes();
    // Of the run's world, where one runs in the recorder's own thread (run_headless).
    void sample(const World& world, double time_s, std::uint64_t edition);

    // Writes the rest of the trace, and the summary.
    void finish(const Summary& summary);

private:
    void flush();

    std::filesystem::path folder_;
    SceneDescription scene_;
    std::size_t hands_;
    std::optional<FolderLock> lock_;
    std::optional<NewFile> trace_, journal_;
    std::optional<TrajectoryFiles> trajectory_;
    std::optional<TrajectorySampler> sampler_;
    std::string rows_;
    std::uint64_t tick_ = 0;
};

}  // namespace palpa
