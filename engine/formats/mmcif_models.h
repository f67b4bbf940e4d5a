// The models of a macromolecular CIF file as the frames of a trajectory.
#pragma once
#include "formats/bytes.h"
#include "formats/trajectory.h"

#include <memory>

namespace palpa {

// A frame is the rows of the loop _atom_site with one pdbx_PDB_model_num, which stand together;
// without that column there is one frame. Atoms come in the order of their rows, as read_mmcif has
// them. The box is _cell, the same in all frames; a cell of 1 Å or less, which stands for none, or
// one that does not parse is none. The text is held as a whole while its frames are found,
// afterwards one frame at a time; most_file_bytes (core/files.h) is its limit. Throws LoadError:
// text that is no CIF, a table that is missing, comes twice or lacks a column, a row that is not
// complete, a model with another number of atoms or in two places; a coordinate that is none when
// its frame is read.
std::unique_ptr<Trajectory> open_mmcif_models(ByteSource source);

}  // namespace palpa
