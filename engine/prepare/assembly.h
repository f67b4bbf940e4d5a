// Builds biological assemblies by the symmetry records of a file.
#pragma once
#include "molecule/atoms.h"
#include "prepare/report.h"

namespace palpa {

// Copies the chains of an assembly by each of its operators. The identity keeps the names of
// chains; each other copy of a chain gets one that is not in use, A to Z, a to z, 0 to 9, then two
// letters, and its name for a segment. A residue without N, CA and C (a ligand, a water, an ion)
// that comes within 1.5 Å of a copy of itself, heavy atoms counted, lies on a symmetry axis: the
// first copy alone is kept, with a warning where that is true of less than half of its atoms.
// Chains that are not in the assembly are left out.
// Throws LoadError where the file has no such assembly, for operators that are no rotation, and for
// assemblies of more than ten million atoms.
Structure build_assembly(const Structure& structure, int assembly, Report& report);

// Warns if assembly 1 of the file is larger than the file's content.
void warn_of_assembly(const Structure& structure, Report& report);

}  // namespace palpa
