// A structure that a test writes down instead of reading a file.
#pragma once
#include "molecule/atoms.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpa::test {

// Names are {segment, residue, number, atom}; at (i, 0, 0), on one line after the other.
inline Structure structure_of(const std::vector<AtomName>& names, const std::string& file = "s.pdb",
                              std::size_t first_line = 1) {
    Structure structure{.file = file, .names = names, .positions = {}, .lines = {}};
    for (std::size_t i = 0; i < names.size(); ++i) {
        structure.positions.emplace_back(static_cast<double>(i), 0, 0);
        structure.lines.push_back(first_line + i);
    }
    return structure;
}

}  // namespace palpa::test
