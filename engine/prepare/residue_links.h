// Finds bonds between residues outside of chains: glycans, hemes, metals, closed chains.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"
#include "prepare/report.h"

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

// A patch on several residues, given by any atom of each, in the order of the patch's digits.
struct LinkPatch {
    std::string patch;
    std::vector<std::size_t> atoms;
};

// The two atoms of a bond that the file states, by their lines, the lower first.
using StatedLinks = std::set<std::pair<std::size_t, std::size_t>>;

// The links of the structure whose atoms are there. To be called before residues are renamed.
StatedLinks find_stated_links(const Structure& structure);

struct ResidueLink {
    std::array<std::size_t, 2> atoms{};
    double distance = 0;     // Å
    bool is_stated = false;  // stated in the file
};

// Heavy atoms of different residues within the sum of their covalent radii and 0.25 Å, or stated
// and within 3 Å. Left out are bonds of chains (peptides, phosphodiesters), disulphides, waters,
// and two residues of chains that only their distance would bond. Rising.
std::vector<ResidueLink> find_residue_links(const ForceField& force_field,
                                            const Structure& structure, const StatedLinks& stated);

// The patches of CHARMM36 for these links: between sugars (14BB), from asparagine (NGLB), serine
// and threonine (SGPA) to a sugar, from histidine to heme (PHEM). Residues have CHARMM's names,
// atoms those of the file. Each link is reported; warns of bonds that have no patch.
std::vector<LinkPatch> patch_links(const ForceField& force_field, const Structure& structure,
                                   const std::vector<ResidueLink>& links, Report& report);

}  // namespace palpa
