// Writes a session to a folder: trace.csv, summary.json, session.toml and the scene's inputs; from
// a window also journal.txt (session/journal.h); on request a trajectory
// (session/trajectory_recorder.h). session/pack_recording.h compresses what is long of it.
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

// A hash over every field of the scene and the content of every file that it names: 16 hex digits.
std::string scene_hash(const SceneDescription& scene);

// The first line of the trace, without its line end. One column per value, named with its unit
// last. Every further hand repeats the columns of the first except time and period, with "_2",
// "_3", ... at the end of the name. If molecules relax, the last columns are the error estimate and
// the age of the model.
std::string trace_header(std::size_t hands = 1, bool relaxes = false);

// One row for one tick of all hands, with its line end. Numbers have the shortest form that reads
// back to the same bits.
std::string trace_row(std::span<const ServoTick> ticks, bool relaxes = false);
inline std::string trace_row(const ServoTick& tick) { return trace_row({&tick, 1}); }

// The summary as a JSON object. Scripts rely on its keys, which tools/recordings.md lists.
std::string format_summary(const SceneDescription& scene, const Summary& summary);

// Throws LoadError if a Recording in this folder would, so that a long computation is not started
// in vain.
void check_record_folder(const std::filesystem::path& folder, bool overwrites);

// Names of input files in a recording.
class InputNames {
public:
    // Names the files of the scene.
    explicit InputNames(const SceneDescription& scene);

    // Adds one file; returns its name, "inputs/NAME".
    std::string add(const std::filesystem::path& file);

private:
    std::set<std::string> taken_;
};

// What drove a recorded session. A session driven by the scene's own hand or by a journal can be
// played again. A trajectory that moved the atoms and the lines of a scripted run are not recorded,
// so these cannot.
enum class RecordedBy { Hand, Journal, Trajectory, Commands };

// True if the folder holds a recording driven by a trajectory, or by the lines of a scripted run.
bool is_of_trajectory(const std::filesystem::path& folder);
bool is_of_commands(const std::filesystem::path& folder);

// Whether it is one of a window: with everything that devices, person and clients did.
bool has_journal(const std::filesystem::path& folder);

// The version of the recording in a folder, which its session.toml states; of one without a number
// that of version 1.
FileVersion read_recording_version(const std::filesystem::path& folder);

// The instruction set of the kernels that computed a recording (field/processor.h), which its
// session.toml states; empty where it does not.
std::string read_recorded_kernels(const std::filesystem::path& folder);

// The scene of a recording that can be played again. Throws LoadError where the folder holds none
// or one of a newer major version, and where something that is not in it moved the atoms: a remote
// engine, a trajectory, commands.
SceneDescription read_recorded_scene(const std::filesystem::path& folder);

class Recording {
public:
    // Makes the folder and writes session.toml and the inputs at once, so that even an interrupted
    // session can be run again. If `overwrites`, the files of a recording in the folder are
    // replaced and no others. Throws LoadError if the folder cannot be written, if another run
    // records into it, or if it is not empty.
    Recording(const std::filesystem::path& folder, const SceneDescription& scene,
              bool overwrites = false, std::size_t hands = 1, RecordedBy by = RecordedBy::Hand);

    // Writes every `every`th tick of all hands as a row. Rows that are written stay readable if the
    // run is interrupted.
    void add(std::span<const ServoTick> ticks);
    void add(const ServoTick& tick) { add({&tick, 1}); }

    // Appends to journal.txt, for a recording by journal.
    void add_journal(const std::string& text);

    // Adds an input that was read while the session ran. `name`: from InputNames. Throws LoadError
    // if it cannot be written.
    void add_input(const std::string& name, const std::string& content);

    // Starts a trajectory beside the trace. If it cannot be written, a note says so.
    void begin_trajectory(const TrajectorySettings& settings);
    void add_frame(const TrajectoryShot& shot);
    // Notes for the user since the last call, one sentence each.
    std::vector<std::string> take_notes();
    // Samples the run's world, for runs in the recorder's own thread (run_headless).
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
