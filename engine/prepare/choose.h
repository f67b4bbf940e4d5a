// Chooses the part of a structure file for the system: one model, one location of every atom, and
// the residues that the user wants.
#pragma once
#include "molecule/atoms.h"
#include "prepare/report.h"
#include "prepare/settings.h"

namespace palpa {

// Takes one model, builds the assembly asked for, leaves out what the settings say and what only
// the crystal needed (crystal_only in molecule/components.h) where it is bonded to nothing, and
// takes of each residue with alternate locations the one with the highest mean occupancy, the first
// in the alphabet where they are equal. Throws LoadError for choices that mean nothing here, and
// where no atom is left.
Structure choose_atoms(const Structure& structure, const PrepareSettings& settings, Report& report);

}  // namespace palpa
