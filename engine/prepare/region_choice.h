// Chooses the region around the hand in which atoms of a large system move; all others are fixed.
#pragma once
#include "molecule/atoms.h"
#include "prepare/system_segments.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace palpa {

// About a quarter as many joints turn. A larger system exceeds the second-order step
// (statics/renewal.h).
inline constexpr std::size_t most_atoms_all_move = 12'000;
// About as many as HIV protease has, whose steps take milliseconds.
inline constexpr std::size_t most_atoms_of_region = 4'000;

struct RegionChoice {
    double angstrom = 0;    // joints.region_angstrom
    std::size_t atoms = 0;  // atoms in residues within this distance
};

// The largest of some distances, from 32 to 8 Å, within which at most `most_atoms_of_region` are;
// the smallest where that many are too near. `held`: atoms of the structure.
RegionChoice choose_region(const Structure& structure, std::span<const SystemSegment> segments,
                           std::span<const std::uint32_t> held);

// Number of atoms of molecules, which joints can move.
std::size_t count_mobile_atoms(std::span<const SystemSegment> segments) noexcept;

}  // namespace palpa
