// From the residue names of a file to those of the force field, protonation included.
#pragma once
#include "charmm/force_field.h"
#include "charmm/missing.h"
#include "molecule/atoms.h"
#include "prepare/report.h"
#include "prepare/settings.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpa {

// A patch on one residue: its protonation.
struct ResiduePatch {
    std::size_t atom;  // any of the residue's
    std::string patch;
};

struct NamedResidues {
    Structure structure;
    std::vector<ResiduePatch> patches;
    // What is wrong with residues: those without a topology (left out of the structure, so that
    // what else is missing can be found too) and choices that fit nothing. To be thrown.
    Missing problems;
};

// Residues are named as the settings say; caps (ACE, NME, NH2) become part of the residue beside
// them, as CHARMM has them; other programs' names (HIS, HIE, ASH, CYX, HOH, NA ...) become CHARMM's
// where the force field does not know them. Histidine without a state gets one
// (prepare/histidine.h); hydrogens that the file has decide about Asp, Glu and Lys.
NamedResidues name_residues(const ForceField& force_field, const Structure& structure,
                            const PrepareSettings& settings, Report& report);

}  // namespace palpa
