// The atoms of a run or session, frame after frame, in files beside its trace: trajectory.dcd, if
// asked trajectory.xtc, and system.psf, which says what the atoms are.
#pragma once
#include "ecs/world.h"
#include "formats/dcd.h"
#include "formats/xtc.h"
#include "math/vec.h"
#include "molecule/connectivity.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct TrajectorySettings {
    static constexpr std::uint64_t usual_most_bytes = std::uint64_t{256} << 20;

    double per_second = 25;  // frames a simulated second; 0: none
    bool writes_xtc = false;
    // The recording's trajectory ends before its files are larger; nothing: there is no limit.
    std::optional<std::uint64_t> most_bytes = usual_most_bytes;
};

// All atoms at one moment.
struct TrajectoryShot {
    double time_s = 0;                           // simulated, from the beginning
    std::vector<Vec3> positions;                 // Å, of the atom table
    std::shared_ptr<const Connectivity> system;  // another one: an edit changed the atoms
};

// When a frame is due, and what it shows. On the thread of the world.
class TrajectorySampler {
public:
    explicit TrajectorySampler(double per_second) : per_second_(per_second) {}

    // Nothing where none is due at that time. `edition`: another number where the atoms may be
    // others than before.
    std::optional<TrajectoryShot> take(const World& world, double time_s, std::uint64_t edition);

private:
    double per_second_;
    std::uint64_t taken_ = 0, edition_ = 0;
    std::shared_ptr<const Connectivity> system_;
};

// Between the thread of the world and that of the recorder.
class TrajectoryQueue {
public:
    void begin(double per_second);
    void end();

    // The world's thread, behind each step: `seconds` are simulated. Never waits for a disk; a
    // frame that finds no room is lost, which take_lost() counts.
    void pass(const World& world, double seconds, std::uint64_t edition);

    // The recorder's thread: what came since the last call.
    std::vector<TrajectoryShot> take();
    std::size_t take_lost();  // likewise, frames

private:
    static constexpr std::size_t most_waiting = 64;

    std::mutex mutex_;
    std::optional<TrajectorySampler> sampler_;
    std::vector<TrajectoryShot> shots_;
    double time_s_ = 0;
    std::size_t lost_ = 0;
};

// The files. What cannot be written ends the trajectory, with a note, and nothing else.
class TrajectoryFiles {
public:
    // Nothing is written before the first frame.
    TrajectoryFiles(std::filesystem::path folder, const TrajectorySettings& settings);

    // A shot of other atoms begins trajectory-2.dcd and system-2.psf, and so on.
    void add(const TrajectoryShot& shot);
    void close();

    // What a user should know, a sentence each, since the last call.
    std::vector<std::string> take_notes();

private:
    void begin(const TrajectoryShot& shot);
    std::filesystem::path name(const char* stem, const char* ending) const;

    std::filesystem::path folder_;
    TrajectorySettings settings_;
    std::shared_ptr<const Connectivity> system_;
    std::optional<DcdWriter> dcd_;
    std::optional<XtcWriter> xtc_;
    std::size_t number_ = 0, frames_ = 0;
    std::uint64_t bytes_ = 0;
    bool is_over_ = false;
    std::vector<std::string> notes_;
};

// Those of a recording's folder, for who replaces it: by their names, and where the format has a
// title by that.
std::vector<std::filesystem::path> list_trajectory_files(const std::filesystem::path& folder);

}  // namespace palpa
