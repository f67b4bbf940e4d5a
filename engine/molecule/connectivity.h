// The connectivity of a structure: its atoms and bonded terms, as in a PSF file.
#pragma once
#include "molecule/atoms.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Atoms in the order of the file, an array per property; everything else names them by index.
struct Connectivity {
    std::string file;
    std::vector<AtomName> names;
    std::vector<std::string> type;   // "CT1"; a number in old files
    std::vector<double> charge;      // e
    std::vector<double> mass;        // amu
    std::vector<std::size_t> lines;  // line of the atom in the file, for messages

    std::vector<std::array<std::uint32_t, 2>> bonds;
    std::vector<std::array<std::uint32_t, 3>> angles;
    std::vector<std::array<std::uint32_t, 4>>
        dihedrals;  // a dihedral with several terms may be repeated
    std::vector<std::array<std::uint32_t, 4>> impropers;
    std::vector<std::array<std::uint32_t, 8>> cmaps;  // two dihedrals each
};

// Adds those atoms of `from`, indices, behind those of `to`, in their order, and the terms among
// them. Returns a bond that leads out of them, if there is one; it and others are left out.
std::optional<std::array<std::uint32_t, 2>> append_atoms(const Connectivity& from,
                                                         std::span<const std::uint32_t> atoms,
                                                         Connectivity& to);

// The same for the atoms of one segment, in the order of the file.
std::optional<std::array<std::uint32_t, 2>> append_segment(const Connectivity& from,
                                                           std::string_view segment,
                                                           Connectivity& to);

}  // namespace palpa
