// What heavy atoms say of hydrogen bonds: who gives, who takes, and how well two of them stand.
#pragma once
#include "math/vec.h"
#include "molecule/atoms.h"
#include "prepare/residues.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa {

enum class HydrogenRole : std::uint8_t {
    None,
    Giver,   // has a hydrogen to give: N-H
    Taker,   // only takes one: carbonyl, carboxylate, the lone pair of a ring's nitrogen
    Both,    // as its surroundings want: hydroxyl, water
    Carbon,  // C-H of a ring: a weak giver
    Metal,   // holds a lone pair, and nothing else
};

// An atom that may take part, and how it looks out of its molecule.
struct HydrogenSite {
    Vec3 place;
    HydrogenRole role = HydrogenRole::None;
    bool is_charged = false;    // of a carboxylate or an ammonium, guanidinium
    std::vector<Vec3> outward;  // unit vectors, one or two; none: any direction
    double half_angle = 0;      // rad, around them within which all is well
    std::size_t atom = 0;       // of the structure; none of a water beside it
};

// The roles of the atoms of amino acids by their names; elsewhere by elements and bonds: oxygens
// with one neighbour closer than 1.32 Å, or on phosphorus or sulphur, only take, other ends are
// hydroxyls. Nothing for amides' ends and rings of histidine, whose roles are to be found.
std::vector<HydrogenSite> find_hydrogen_sites(const Structure& structure,
                                              const std::vector<ResidueRange>& residues);

// Beyond it two sites mean nothing to each other.
inline constexpr double hydrogen_bond_reach = 4;  // Å

// Of two sites: 1 for a giver and a taker 3 Å apart that face each other, -1 for two of a kind,
// fading to 0 at 4 Å and 60 degrees aside; a little for C-H and a taker.
double score_contact(const HydrogenSite& a, const HydrogenSite& b) noexcept;

}  // namespace palpa
