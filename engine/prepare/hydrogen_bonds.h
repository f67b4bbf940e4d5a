// Scores possible hydrogen bonds from heavy atoms: donors, acceptors, and their geometry.
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
    Giver,   // donor: N-H
    Taker,   // acceptor only: carbonyl, carboxylate, lone pair of a ring nitrogen
    Both,    // donor or acceptor: hydroxyl, water
    Carbon,  // weak donor: C-H of a ring
    Metal,   // metal ion: binds lone pairs only
};

// A possible donor or acceptor with its directions.
struct HydrogenSite {
    Vec3 place;
    HydrogenRole role = HydrogenRole::None;
    bool is_charged = false;    // part of a carboxylate, ammonium or guanidinium
    std::vector<Vec3> outward;  // unit vectors, one or two; none: any direction
    double half_angle = 0;      // rad; within this angle of them the direction is ideal
    std::size_t atom = 0;       // atom of the structure; unset for an external water
};

// The roles of the atoms of amino acids by their names; elsewhere by elements and bonds: oxygens
// with one neighbour closer than 1.32 Å, or on phosphorus or sulphur, only take, other ends are
// hydroxyls. Nothing for amides' ends and rings of histidine, whose roles are to be found.
std::vector<HydrogenSite> find_hydrogen_sites(const Structure& structure,
                                              const std::vector<ResidueRange>& residues);

// Largest distance of two sites with a score.
inline constexpr double hydrogen_bond_reach = 4;  // Å

// Of two sites: 1 for a giver and a taker 3 Å apart that face each other, -1 for two of a kind,
// fading to 0 at 4 Å and 60 degrees aside; a little for C-H and a taker.
double score_contact(const HydrogenSite& a, const HydrogenSite& b) noexcept;

}  // namespace palpa
