// Chooses what the hand of the scene holds, and in which direction it moves best.
#pragma once
#include "math/vec.h"
#include "molecule/atoms.h"
#include "prepare/system_segments.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct HandChoice {
    std::string segment;
    std::string
        atom;  // held by a spring: residue ("36"), or residue and atom; empty: the whole molecule
    std::vector<std::uint32_t> held;  // atoms of the structure, rising
    std::string words;                // "residue PRO 36 of A, on a spring"
    std::string reason;               // reason of the choice
};

// `grab`: "SEGMENT", the whole molecule, or "SEGMENT:RESIDUE", a residue on a spring. Empty: the
// smallest molecule, a ligand, a peptide or a chain of at most 2,000 atoms beside others, of those
// alike the last; else of the largest molecule the residue that has the fewest heavy atoms within
// 10 Å, since that moves most easily.
// Throws LoadError where there is nothing of that name, or nothing to hold.
HandChoice choose_hand(const Structure& structure, std::span<const SystemSegment> segments,
                       std::string_view grab);

// Lists what a person may want to hold, at most `most` things: what choose_hand takes by itself
// comes first, then other molecules of at most 2,000 atoms, the small ones before the large ones,
// then the residue of each larger molecule that moves most easily. Empty where there is nothing to
// hold.
std::vector<HandChoice> list_hand_choices(const Structure& structure,
                                          std::span<const SystemSegment> segments,
                                          std::size_t most = 6);

// Describes the choice as its `words` do, in the language in use (core/translate.h).
std::string translated_words(const Structure& structure, const HandChoice& choice);
// Returns the choice in the form that `grab` of choose_hand takes.
std::string grab_of(const HandChoice& choice);

// The residue of the largest molecule that moves most easily, by the same rule.
HandChoice choose_residue(const Structure& structure, std::span<const SystemSegment> segments);

// The direction in which what is held meets the fewest heavy atoms on its next 12 Å; of those alike
// the one that leads most away from its neighbours. A unit vector.
Vec3 find_way_out(const Structure& structure, std::span<const std::uint32_t> held);

// The centre of these atoms, of the heavy ones if there are any, Å.
Vec3 middle_of(const Structure& structure, std::span<const std::uint32_t> atoms);

}  // namespace palpa
