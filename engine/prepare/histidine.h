// Which nitrogen of a histidine carries its hydrogen, where the file does not tell.
#pragma once
#include "molecule/atoms.h"
#include "prepare/residues.h"

#include <string>
#include <string_view>

namespace palpa {

struct HistidineChoice {
    std::string_view residue;  // "HSD", hydrogen on ND1; "HSE", on NE2; "HSP", on both
    std::string reason;
    bool might_be_charged = false;  // both nitrogens have an acceptor
};

// By the hydrogens that are there. Without any, by what is within 3.4 Å of each nitrogen and
// outside of the ring, towards which it points within 60 degrees: an oxygen that only accepts
// (carbonyl, carboxylate) wants a hydrogen, a nitrogen that only gives (backbone N, Lys NZ, Arg,
// Trp NE1, amides) or a metal within 2.6 Å wants none. HSE where both states are as good: it is the
// more frequent tautomer in water.
HistidineChoice choose_histidine(const Structure& structure, const ResidueRange& residue);

}  // namespace palpa
