// Reads and writes XTC trajectories of GROMACS: coordinates rounded, usually to 0.001 nm, and
// packed.
#pragma once
#include "formats/bytes.h"
#include "formats/trajectory.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

namespace palpa {

// XDR: numbers in big-endian order (GROMACS reference manual, "xtc"). A frame: 1995, atoms, step
// (integers), time (float, ps), box (9 floats, nm, edge by edge), atoms again; up to 9 atoms as
// floats, nm; more of them packed (formats/xtc_packing.h). A box of zeros counts as none.
// Throws LoadError: no XTC, a frame with another number of atoms, the newer form (2023) for more
// than 298 million atoms, packed coordinates that do not unpack.
std::unique_ptr<Trajectory> open_xtc(ByteSource source);

// All functions throw LoadError: an existing file, one that cannot be written, invalid positions.
class XtcWriter {
public:
    // `precision`: steps per nanometre to which coordinates of more than 9 atoms are rounded.
    XtcWriter(const std::filesystem::path& path, std::size_t atom_count, float precision = 1000);

    // `positions`: Å, one an atom; `box`: columns are edges, Å, zeros in the file without one.
    // A frame is in the file as a whole when this returns.
    void add_frame(std::span<const Vec3> positions, std::int32_t step, double time_ps,
                   const std::optional<Mat3>& box = {});
    std::size_t frame_count() const noexcept { return frames_; }

    // Throws if the system could not write everything.
    void close() { file_.close(); }

private:
    GrowingFile file_;
    std::size_t atom_count_;
    float precision_;
    std::size_t frames_ = 0;
};

}  // namespace palpa
