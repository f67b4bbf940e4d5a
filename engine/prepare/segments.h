// Splits a structure into segments: chains with ends and gaps, disulphides, and the patches that
// they need.
#pragma once
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "molecule/atoms.h"
#include "prepare/report.h"
#include "prepare/residue_names.h"
#include "prepare/settings.h"

#include <span>
#include <vector>

namespace palpa {

// Splits the structure into segments, in place, and says how they are generated.
//
// Residues that a template bonds to the next one ('+' in a bond) are chains: neighbours whose atoms
// of that bond are within 2.5 Å of each other are one segment, called like the chain; where an atom
// of the bond is missing, successive numbers count. What follows a gap is another segment. The ends
// of a chain get what the templates say (NTER, GLYP, PROP, CTER). At a gap the chain goes on in
// nature, so that no charge belongs there: ACE (ACP before proline) and CT3 close it, unless the
// file has the oxygen of an end (OXT). Caps of the file stay. All other residues are segments of
// their own, called like the residue; waters and ions are gathered by chain.
//
// Two SG closer than 2.5 Å are bonded, nearest first. `protonation`: patches that
// residues need beside. Throws a LoadError with all choices that fit nothing, and with
// residues that share a number.
GenerateSettings split_segments(const ForceField& force_field, Structure& structure,
                                const std::vector<ResiduePatch>& protonation,
                                const PrepareSettings& settings, Report& report,
                                std::span<const LinkPatch> links = {});

}  // namespace palpa
