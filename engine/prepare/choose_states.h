// Chooses flips of amides and histidines, and the protonation of histidines, together, by the
// possible hydrogen bonds.
#pragma once
#include "math/vec.h"
#include "molecule/atoms.h"
#include "prepare/residues.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct StateSettings {
    bool may_flip = true;
    std::span<const Vec3> waters;  // oxygens of waters outside of the structure, Å
    // First atoms of residues that stay unchanged, ascending; a histidine among them has a state.
    std::span<const std::size_t> given;
    // First atoms of residues that are not flipped.
    std::span<const std::size_t> held;
};

struct ChosenState {
    std::size_t residue = 0;     // first atom of the residue
    std::string_view histidine;  // "HSD", "HSE" or "HSP"; empty for an amide
    bool is_flipped = false;
    double gain = 0;  // gain of the flip in hydrogen bonds
    std::string reason;
    bool might_be_charged = false;  // both nitrogens have an acceptor, but no acid is near
};

// Of every HIS, ASN and GLN that is whole and has no hydrogens on the atoms in question; histidines
// with hydrogens, or not whole, get the state that these tell, HSE without.
//
// A score counts hydrogen bonds (score_contact in prepare/hydrogen_bonds.h): nothing beyond 4 Å
// counts, so no charge far away turns an amide. A flip must gain 0.6 hydrogen bonds, and find
// a partner that the other way round lacks. HSP costs nine tenths, and needs an acid. Where
// histidines are equal, HSE: the more frequent tautomer in water. Groups within reach of each other
// are tried in all combinations up to 20,000, others in turn until nothing changes.
std::vector<ChosenState> choose_states(const Structure& structure, const StateSettings& settings);

}  // namespace palpa
