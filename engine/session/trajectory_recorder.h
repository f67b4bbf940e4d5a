// Writes the atoms of a run or session to files beside its trace: trajectory.dcd, on request
// trajectory.xtc, and system.psf, which describes the atoms.
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
    // The trajectory ends before its files exceed this size; nothing: no limit.
    std::optional<std::uint64_t> most_bytes = usual_most_bytes;
};

// The positions of all atoms at one time.
struct TrajectoryShot {
    double time_s = 0;            // simulated time from the beginning
    std::vector<Vec3> positions;  // Å, in the order of the atom table
    std::shared_ptr<const Connectivity>
        system;  // a new pointer means that an edit changed the atoms
};

// Takes frames when they are due. Runs on the thread of the world.
class TrajectorySampler {
public:
    explicit TrajectorySampler(double per_second) : per_second_(per_second) {}

    // Returns nothing if no frame is due at that time. `edition`: changes whenever the atoms may
    // have changed.
    std::optional<TrajectoryShot> take(const World& world, double time_s, std::uint64_t edition);

private:
    double per_second_;
    std::uint64_t taken_ = 0, edition_ = 0;
    std::shared_ptr<const Connectivity> system_;
};

// Passes frames from the thread of the world to that of the recorder.
class TrajectoryQueue {
public:
    void begin(double per_second);
    void end();

    // For the world's thread, after each step: `seconds` are simulated. Never waits for a disk; if
    // there is no room, the frame is lost and counted in take_lost().
    void pass(const World& world, double seconds, std::uint64_t edition);

    // For the recorder's thread: frames since the last call.
    std::vector<TrajectoryShot> take();
    std::size_t
    take_lost();  // for the recorder's thread: number of lost frames since the last call

private:
    static constexpr std::size_t most_waiting = 64;

    std::mutex mutex_;
    std::optional<TrajectorySampler> sampler_;
    std::vector<TrajectoryShot> shots_;
    double time_s_ = 0;
    std::size_t lost_ = 0;
};

// Writes the files. An error of writing ends the trajectory with a note; the run goes on.
class TrajectoryFiles {
public:
    // Writes nothing before the first frame.
    TrajectoryFiles(std::filesystem::path folder, const TrajectorySettings& settings);

    // A frame with other atoms begins trajectory-2.dcd and system-2.psf, and so on.
    void add(const TrajectoryShot& shot);
    void close();

    // Notes for the user since the last call, one sentence each.
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

// The trajectory files of a recording's folder, found by name and, for formats with a title, by
// title, so that a new recording can replace them.
std::vector<std::filesystem::path> list_trajectory_files(const std::filesystem::path& folder);

}  // namespace palpa
