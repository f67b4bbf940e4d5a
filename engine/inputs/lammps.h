// Writes the input files of a LAMMPS run, as text.
#pragma once
#include "core/files.h"
#include "inputs/run_system.h"

#include <vector>

namespace palpa {

// LAMMPS's "real" units (Å, kcal/mol, fs) and CHARMM's own forms of its package MOLECULE. `system`
// is in the order of `in_run_order`; paths are names without a folder.
//
//   system.data  atoms, terms and their numbers, places with the periodic image that each is in
//   system.cmap  the maps of cross-terms, where there are any
//   run.in       the run: in a box PPPM and CHARMM36's force switch from 10 to 12 Å; in vacuum all
//                pairs. It waits for a client at `port`, unless -var port 0; -var steps 0 only
//                prints each energy of the places; -var rigid 0 makes nothing rigid
//   run.sh       one line that starts it
//
// In a box these styles have CHARMM's Coulomb constant, in vacuum LAMMPS's, which "dielectric"
// makes the system's. Coordinates go out and forces come in at different steps: with a rate of 1
// LAMMPS would never take a force. Throws LoadError for what LAMMPS lacks: dihedrals whose phase
// is no whole degree, impropers about another angle than 0 or 180 degrees, more than six maps or
// maps of other than 24 x 24 points, cross-terms of other than five atoms in a row.
std::vector<TextFile> format_lammps(const RunSystem& system, const EngineRunOptions& options);

}  // namespace palpa
