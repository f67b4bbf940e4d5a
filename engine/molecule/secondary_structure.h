// Secondary structure of proteins from backbone hydrogen bonds by the rules of DSSP: W. Kabsch, C.
// Sander, Biopolymers 22, 2577 (1983).
#pragma once
#include "math/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

enum class SecondaryStructure : std::uint8_t {
    Coil,
    AlphaHelix,     // DSSP's H
    ThreeTenHelix,  // G
    PiHelix,        // I
    Strand,         // E: of a ladder of two bridges or more
    Bridge,         // B: a bridge alone
};

inline bool is_helix(SecondaryStructure structure) noexcept {
    return structure == SecondaryStructure::AlphaHelix ||
           structure == SecondaryStructure::ThreeTenHelix ||
           structure == SecondaryStructure::PiHelix;
}

// Where a residue has these four atoms, Å. One that lacks an atom is omitted, and the next one
// then does not follow.
struct BackboneResidue {
    Vec3 n, alpha, c, o;
    bool follows = false;     // its N is bonded to the C of the residue before it in the list
    bool is_proline = false;  // so its N has no hydrogen
};

// Whether a C and an N are near enough for the bond between two residues, as DSSP has it: 2.5 Å.
bool is_peptide_bond(const Vec3& c, const Vec3& n) noexcept;

// One a residue, of all chains together. It is DSSP's of version 4: its states but for turns, bends
// and polyproline helices, which are coil here; of two that a residue could have, pi helix comes
// before alpha helix, that before strand, that before bridge, that before 3-10 helix. An amide
// hydrogen is 1 Å from its N, opposite to C=O of the residue before. Takes time proportional to the
// number of residues.
std::vector<SecondaryStructure> find_secondary_structure(std::span<const BackboneResidue> residues);

// Caches the result while residues hardly move.
class SecondaryStructureCache {
public:
    // Those of the last time, unless a CA or O has moved by 0.5 Å or more since the classes were
    // found, or residues are others. The span lasts until the next call.
    std::span<const SecondaryStructure> update(std::span<const BackboneResidue> residues);

    // Number of computations so far.
    std::size_t times_found() const noexcept { return times_found_; }

private:
    bool is_as_found(std::span<const BackboneResidue> residues) const noexcept;

    std::vector<BackboneResidue> residues_;  // residues at the last computation
    std::vector<SecondaryStructure> classes_;
    std::size_t times_found_ = 0;
};

}  // namespace palpa
