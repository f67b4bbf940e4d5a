// Reads and writes DCD trajectories of CHARMM, NAMD and X-PLOR.
#pragma once
#include "formats/bytes.h"
#include "formats/trajectory.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace palpa {

// Fortran's unformatted records, each between two marks of four bytes that tell its length, in
// either byte order (CHARMM's manual, ICNTRL; NAMD's user guide, file formats):
//   'CORD', ICNTRL(20)   1 frames, 2 first step, 3 steps between frames, 9 fixed atoms, 10 time
//                        step, 11 has a cell, 12 has a fourth dimension, 20 version (0: X-PLOR)
//   titles of 80 letters; number of atoms; numbers of the atoms that move, if some are fixed
//   a frame: cell (6 doubles), x, y, z (floats, Å); behind the first only of atoms that move.
// The cell is a, gamma, b, beta, alpha, c. Angles are cosines if all are within ±1 (NAMD), or else
// degrees; CHARMM, which writes its version as more than 24, has a symmetric matrix by its lower
// triangle instead. A cell that is none of these counts as no box. Time steps are in AKMA units.
// Frames are those that the file holds; where the header has another number, a note says so.
// Throws LoadError: no DCD, velocities (VELD), records of other lengths, 8-byte marks, charges.
std::unique_ptr<Trajectory> open_dcd(ByteSource source);

struct DcdOptions {
    std::string title;               // printable ASCII; cut at 80 letters a line
    bool has_box = false;            // whether every frame has a box
    std::int32_t first_step = 0;     // step of the first frame
    std::int32_t steps_between = 1;  // steps between two frames
    double timestep_ps = 0;          // time step; 0: unknown
};

// Writes the CHARMM form in little-endian order, as NAMD does, with the cell as lengths and
// cosines. The header's number of frames is right after every frame. All throw LoadError: a file
// that is there, one that cannot be written, positions that are none.
class DcdWriter {
public:
    DcdWriter(const std::filesystem::path& path, std::size_t atom_count, const DcdOptions& options);

    // `positions`: Å, one an atom; `box` as options say, with a along x and b in the plane of x and
    // y, which is all that the format can tell.
    void add_frame(std::span<const Vec3> positions, const std::optional<Mat3>& box = {});
    std::size_t frame_count() const noexcept { return frames_; }

    // Throws if the system could not write everything.
    void close() { file_.close(); }

private:
    GrowingFile file_;
    std::size_t atom_count_;
    bool has_box_;
    std::int32_t steps_between_;
    std::size_t frames_ = 0;
};

}  // namespace palpa
