// Joins residues of a file that are part of the neighbouring residue in CHARMM.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "prepare/report.h"
#include "prepare/residue_links.h"

namespace palpa {

// ACE, NME and NH2 become part of the amino acid beside them, their atoms named as CHARMM's patches
// have them.
void join_caps(Structure& structure, Report& report);

// Retinal on a lysine, a fatty acid on a cysteine and the like (joined_components in
// molecule/components.h) become one residue with it, where the force field has that; their atoms
// then stand behind the amino acid's.
void join_components(const ForceField& force_field, const StatedLinks& stated, Structure& structure,
                     Report& report);

}  // namespace palpa
