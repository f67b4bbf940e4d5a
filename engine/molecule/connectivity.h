// What a structure's atoms are and which of them are bonded, as a PSF file has it.
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
    std::vector<std::string> type;   // "CT1"; in old files a number
    std::vector<double> charge;      // e
    std::vector<double> mass;        // amu
    std::vector<std::size_t> lines;  // the atom's line in the file, for messages

    std::vector<std::array<std::uint32_t, 2>> bonds;
    std::vector<std::array<std::uint32_t, 3>> angles;
    std::vector<std::array<std::uint32_t, 4>> dihedrals;  // one that has several terms may recur
    std::vector<std::array<std::uint32_t, 4>> impropers;
    std::vector<std::array<std::uint32_t, 8>> cmaps;  // two dihedrals each
};

// Adds those atoms of `from`, indices, behind those of `to`, in their order, and the terms among
// them. Returns a bond that leads out of them, if there is one; it and others are left out.
std::optional<std::array<std::uint32_t, 2>> append_atoms(const Connectivity& from,
                                                         std::span<const std::uint32_t> atoms,
                                                         Connectivity& to);

// The same with the atoms of one segment, in the order of the file.
std::optional<std::array<std::uint32_t, 2>> append_segment(const Connectivity& from,
                                                           std::string_view segment,
                                                           Connectivity& to);

}  // namespace palpa
