// Builds the connectivity of a structure from residues and patches, as CHARMM's GENERATE and PATCH
// do.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <string>
#include <vector>

namespace palpa {

// A residue of a structure.
struct ResidueId {
    std::string segment;
    std::string number;  // with its insertion code
};

// Settings for generating one segment.
struct SegmentSettings {
    std::string segment;
    std::string first, last;          // patches at its ends. "NONE": none; empty: what the
                                      // residue's template says
    bool has_generated_terms = true;  // angles and dihedrals; false: NOANGLE NODIHEDRAL
};

// A patch by name, and the residues that its digits mean ("1SG", "2SG"), in this order.
struct PatchUse {
    std::string patch;
    std::vector<ResidueId> residues;
};

struct GenerateSettings {
    std::vector<SegmentSettings>
        segments;  // only segments that differ from the defaults of their residues
    std::vector<PatchUse> patches;
    // Two CYS without HG1 whose SG are closer than this are bonded (patch DISU), unless a patch
    // above has one of them. A bond is 2.05 Å long. 0: never.
    double disulphide_distance = 2.5;  // Å
};

// A bond longer than this is none: it lies over a gap of its chain. In crambin and five proteins
// more the longest bond is a disulphide of 2.08 Å; where a residue is left out of them, the C
// before and the N behind it are 2.8 to 4.9 Å apart, and more than 3 Å in 505 of 511 places.
inline constexpr double longest_bond = 3;  // Å

// Does what GENERATE, PATCH and AUTOGENERATE do in CHARMM. Segments are chains, which TER lines
// (`Structure::chain_ends`) part further: a residue is bonded to the one before it by names with
// '+' and '-', so a chain with a gap is two segments. Residues are what has one segment, number and
// name, in the order of their first atoms; atoms are found by name. A term with an atom that a
// patch deletes, or that a neighbour lacks, is left out. Angles and dihedrals are all that the
// bonds make once every patch is in, but for residues with NOANG or NODIH (older files of water do
// not say so: its segment has to), and those that a residue gives.
//
// Atoms of the result stand in the order of the structure. All of the atoms that the templates name
// must be there, hydrogens too, and no others, and no bond between two known positions may be
// longer than `longest_bond`. Everything that is wrong (residues, patches, atoms, types, charges,
// bonds) is gathered before a LoadError names it; of residues whose own template or patch is
// missing no more is said.
Connectivity build_connectivity(const ForceField& force_field, const Structure& structure,
                                const GenerateSettings& settings = {});

}  // namespace palpa
