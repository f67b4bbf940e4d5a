// Reads TRR trajectories of GROMACS: positions, velocities and forces in full precision.
#pragma once
#include "formats/bytes.h"
#include "formats/trajectory.h"

#include <memory>

namespace palpa {

// XDR: numbers in big-endian order (GROMACS reference manual, "trr"). A frame: 1993, a version
// "GMX_trn_file", the bytes of ten blocks, atoms, step, a reserved number (integers), time (ps),
// lambda, then the blocks: box (9 numbers, nm), virial, pressure, positions (nm), velocities
// (nm/ps), forces (kJ/mol/nm). All real numbers of a frame are floats, or all doubles, as the
// blocks' sizes tell. Frames without positions are left out, which a note counts.
// Throws LoadError: no TRR, a frame with another number of atoms, blocks of other sizes.
std::unique_ptr<Trajectory> open_trr(ByteSource source);

}  // namespace palpa
