// The segments of a prepared system and their kinds for a scene.
#pragma once
#include "molecule/atoms.h"
#include "molecule/connectivity.h"

#include <cstdint>
#include <string>
#include <vector>

namespace palpa {

enum class SegmentKind : std::uint8_t {
    Molecule,  // more than three atoms in one bonded piece
    Water,
    Other,  // ions, and segments in several pieces
};

struct SystemSegment {
    std::string name;
    SegmentKind kind = SegmentKind::Molecule;
    std::vector<std::uint32_t> atoms;  // of the structure, rising
};

// In the order of their first atoms. `connectivity`: of the same atoms in the same order.
std::vector<SystemSegment> find_segments(const Structure& structure,
                                         const Connectivity& connectivity);

// A scene's molecules are not bonded to each other: segments that are (by a disulphide, a glycan)
// become one, called like the first of them; residues of the others keep their number behind the
// name that their segment had, "B:7". Returns the lists of names that were joined.
std::vector<std::vector<std::string>> join_bonded_segments(Structure& structure,
                                                           Connectivity& connectivity);

}  // namespace palpa
