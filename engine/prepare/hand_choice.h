// What of a prepared system the hand of its scene holds, and which way that goes best.
#pragma once
#include "math/vec.h"
#include "molecule/atoms.h"
#include "prepare/system_segments.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct HandChoice {
    std::string segment;
    std::string atom;  // on a spring: residue ("36"), or residue and atom; empty: all of it
    std::vector<std::uint32_t> held;  // atoms of the structure, rising
    std::string words;                // "residue PRO 36 of A, on a spring"
    std::string reason;               // why it was taken
};

// `grab`: "SEGMENT", the whole molecule, or "SEGMENT:RESIDUE", a residue on a spring. Empty: the
// smallest molecule, a ligand, a peptide or a chain of at most 2,000 atoms beside others, of those
// alike the last; else of the largest molecule the residue that has the fewest heavy atoms within
// 10 Å, since that moves most easily.
// Throws LoadError where there is nothing of that name, or nothing to hold.
HandChoice choose_hand(const Structure& structure, std::span<const SystemSegment> segments,
                       std::string_view grab);

// Of the largest molecule the residue that moves most easily, as above.
HandChoice choose_residue(const Structure& structure, std::span<const SystemSegment> segments);

// The direction in which what is held meets the fewest heavy atoms on its next 12 Å; of those alike
// the one that leads most away from its neighbours. A unit vector.
Vec3 find_way_out(const Structure& structure, std::span<const std::uint32_t> held);

// The middle of these atoms, heavy ones alone if there are any.
Vec3 middle_of(const Structure& structure, std::span<const std::uint32_t> atoms);

}  // namespace palpa
