// Reads structure files of all formats, recognised by their names.
#pragma once
#include "molecule/atoms.h"

#include <filesystem>

namespace palpa {

// .pdb and .ent (read_pdb), .cif and .mmcif (read_mmcif), .crd and .cor (read_crd), .gro
// (read_gro), in letters of either case, compressed too (".pdb.gz"). Throws LoadError for any other
// name, and as these do.
Structure read_structure(const std::filesystem::path& path);

}  // namespace palpa
