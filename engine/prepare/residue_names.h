// Renames residues from the names of a file to those of the force field, and chooses protonation.
#pragma once
#include "charmm/force_field.h"
#include "charmm/missing.h"
#include "molecule/atoms.h"
#include "prepare/report.h"
#include "prepare/residue_advice.h"
#include "prepare/residue_links.h"
#include "prepare/settings.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// A patch on one residue: its protonation.
struct ResiduePatch {
    std::size_t atom;  // any atom of the residue
    std::string patch;
};

struct NamedResidues {
    Structure structure;
    std::vector<ResiduePatch> patches;
    std::vector<LinkPatch> links;
    std::vector<UnknownResidue> unknown;
    // Problems of residues: unknown ones (left out of the structure, so that other problems can be
    // found too) and settings that match nothing. The caller must throw them.
    Missing problems;
};

// Residues are named as the settings say; caps (ACE, NME, NH2) become part of the residue beside
// them, as CHARMM has them, and so do lipids and retinal on their amino acid; names of the PDB and
// of other programs (HIS, HIE, ASH, CYX, HOH, NA, DA, NAG, HEM ...) become CHARMM's
// (molecule/components.h). A molecule of the force field that is only called alike is not taken:
// elements and bonds must be the same. Histidine without a state gets one
// (prepare/choose_states.h); hydrogens that the file has decide about Asp, Glu and Lys.
// `waters`: oxygens of waters that are not in the structure, Å.
NamedResidues name_residues(const ForceField& force_field, const Structure& structure,
                            const PrepareSettings& settings, Report& report,
                            std::span<const Vec3> waters = {});

}  // namespace palpa
