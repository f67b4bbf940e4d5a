// Flips the amides and imidazoles that a user names.
#pragma once
#include "charmm/missing.h"
#include "molecule/atoms.h"
#include "prepare/report.h"
#include "prepare/residue_links.h"
#include "prepare/settings.h"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

inline constexpr std::string_view turned_heading = "Flipped amides and histidines";

// Turns each of them once and returns the first atoms of their residues, rising. Noted in `missing`
// is a choice of no residue, of one without such a side chain, or without all its heavy atoms, or
// of an amide that `bonds` hold. Residues have CHARMM's names, or are HIS.
std::vector<std::size_t> turn_as_asked(std::span<const ResidueChoice> flips,
                                       std::span<const ResidueLink> bonds, Structure& structure,
                                       Report& report, Missing& missing);

}  // namespace palpa
