// Writes the input files of a GROMACS run, as text.
#pragma once
#include "core/files.h"
#include "inputs/run_system.h"

#include <vector>

namespace palpa {

// GROMACS's own names and conventions (reference manual, "Topology file"): nm, kJ/mol, harmonic
// terms with a half. `system` is in the order of `in_run_order`; paths are names without a folder.
//
//   system.gro  places, nine decimals, moved into the box
//   system.top  everything of the force field, in full, by number; alike molecules once. Waters
//               are rigid (SETTLE), with -DFLEXIBLE as the force field has them
//   run.mdp     dynamics: PME and CHARMM36's force switch from 10 to 12 Å in a box, or a shorter
//               one that the box has room for; in vacuum all pairs, in a box that is so much larger
//   energy.mdp  in vacuum: each energy of the same places, all flexible, by mdrun -rerun
//   index.ndx   groups System and sent
//   run.sh      one line that starts it and waits for a client
//
// The Coulomb constant is the system's, by way of epsilon-r: GROMACS's own is 138.935458 kJ nm
// mol^-1 e^-2. Throws LoadError for what GROMACS lacks: cross-terms of other than five atoms in a
// row, or of maps of different sizes.
std::vector<TextFile> format_gromacs(const RunSystem& system, const EngineRunOptions& options);

// The positions of the atoms in system.gro, Å.
std::vector<Vec3> gromacs_positions(const RunSystem& system);

// Shortest box edge with room for a cutoff, Å.
inline constexpr double shortest_gromacs_edge = 10;

// Å; from where Lennard-Jones forces are switched off, and where all pairs end.
struct Cutoff {
    double from, to;
};
// The cutoff of CHARMM36, or a shorter one for half of the shortest box edge. Throws LoadError if
// the box is too small.
Cutoff gromacs_cutoff(const RunSystem& system);

}  // namespace palpa
