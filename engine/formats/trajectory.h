// Trajectories of molecular simulations: the positions of the same atoms, frame after frame.
#pragma once
#include "formats/bytes.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

struct TrajectoryFrame {
    std::vector<Vec3> positions;       // Å, one an atom
    std::vector<Vec3> velocities;      // Å/ps; empty if the file has none
    std::vector<Vec3> forces;          // kcal/mol/Å; empty if the file has none
    std::optional<Mat3> box;           // its columns are the edges, Å (formats/box.h)
    std::optional<double> time_ps;     // ps
    std::optional<std::int64_t> step;  // step of the simulation
};

// An open trajectory. Frames count from 0, in messages from 1. It holds an index of where frames
// are, and a frame while it reads one; for one thread.
class Trajectory {
public:
    Trajectory() = default;
    Trajectory(const Trajectory&) = delete;
    Trajectory& operator=(const Trajectory&) = delete;
    virtual ~Trajectory() = default;

    virtual std::size_t atom_count() const noexcept = 0;   // at least 1, in every frame
    virtual std::size_t frame_count() const noexcept = 0;  // number of complete frames, at least 1

    // Reads a frame, in any order, into `into`, whose memory is reused. Throws LoadError with file
    // and frame: a frame that does not exist, an invalid coordinate, a damaged record.
    virtual void read_frame(std::size_t frame, TrajectoryFrame& into) = 0;

    // Notes for the user, one sentence each, such as a file that ends within a frame.
    const std::vector<std::string>& notes() const noexcept { return notes_; }

protected:
    std::vector<std::string> notes_;
};

// .dcd (formats/dcd.h), .xtc (formats/xtc.h), .trr (formats/trr.h), .pdb and .ent
// (formats/pdb_models.h), .cif and .mmcif (formats/mmcif_models.h), in letters of either case.
// Throws LoadError for any other name, for a file without a whole frame, and as these do.
std::unique_ptr<Trajectory> open_trajectory(const std::filesystem::path& path);

// For readers. "file: frame 3: what"
[[noreturn]] void fail_frame(const std::string& file, std::size_t frame, const std::string& what);

// Throws LoadError if the trajectory does not have this frame.
void check_frame(const std::string& file, std::size_t frame, std::size_t count);

// Throws LoadError if a position is not finite or beyond `farthest_coordinate` (formats/lines.h).
void check_positions(const std::string& file, std::size_t frame, std::span<const Vec3> positions);

// "ends within frame 3: the file may have been cut off"
std::string cut_off_note(std::size_t frame);

}  // namespace palpa
