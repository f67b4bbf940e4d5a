// Pairs of atoms that a linearised model represents by parabolas, which have no repulsive wall.
#pragma once
#include "statics/torsion_model.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Non-bonded pairs of atoms in two bodies that were close at the point of linearisation, without
// exact pairs (a held atom and one near it that is not held).
struct ClosePairs {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    std::vector<double> least_squares;  // Å², squared distance below which a pair is too close
};

// Pairs within `reach`, Å; those within `near_reach` of a held atom are exact. A pair is too close
// below four fifths of its distance, or of the distance of least energy if that is smaller: there a
// wall of r^-12 is fifteen times as high.
ClosePairs build_close_pairs(const TorsionModel& model, std::span<const Vec3> positions,
                             std::span<const std::uint32_t> held, double near_reach, double reach);

// True if any pair is too close.
bool are_too_close(const ClosePairs& close, std::span<const Vec3> positions) noexcept;

}  // namespace palpa
