// The models of a PDB file as the frames of a trajectory.
#pragma once
#include "formats/bytes.h"
#include "formats/trajectory.h"

#include <memory>

namespace palpa {

// A frame ends with ENDMDL, or with END behind atoms, as some programs separate frames; its atoms
// are the ATOM and HETATM records in their order, as read_pdb has them. The file is never held as a
// whole. The box is that of CRYST1 among the lines of the frame, or else before the first; a cell
// of 1 Å or less, which stands for none, or one that does not parse is none. The time is what a
// TITLE of the frame says behind "t=", ps, as GROMACS writes it. A frame that the file's end cuts
// off is left out, which a note says. Throws LoadError: a file without atoms, a frame with another
// number of atoms; a coordinate that is none when its frame is read.
std::unique_ptr<Trajectory> open_pdb_models(ByteSource source);

}  // namespace palpa
