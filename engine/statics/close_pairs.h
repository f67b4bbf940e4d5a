// Pairs of atoms that a linearised model has as parabolas, so that nothing keeps them apart.
#pragma once
#include "statics/torsion_model.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Non-bonded pairs of atoms of two bodies that were close at the point of linearisation, but for
// those that are exact: of an atom that is held and one near it that is not.
struct ClosePairs {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    std::vector<double> least_squares;  // Å²: of the distance below which each is too close
};

// Pairs within `reach`, Å; those within `near_reach` of a held atom are exact. Too close is four
// fifths of the distance that they have, or of that of the least energy if that is less: there a
// wall of r^-12 is fifteen times as high.
ClosePairs build_close_pairs(const TorsionModel& model, std::span<const Vec3> positions,
                             std::span<const std::uint32_t> held, double near_reach, double reach);

// Whether a pair is.
bool are_too_close(const ClosePairs& close, std::span<const Vec3> positions) noexcept;

}  // namespace palpa
