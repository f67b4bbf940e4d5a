// Second derivatives of listed pairs, in double; models that are exact near the hand subtract them
// from those of all pairs.
#pragma once
#include "statics/second_derivatives.h"

#include <array>
#include <cstdint>
#include <span>

namespace palpa {

// As update_second_derivatives, but for some pairs only, each named once: `pairs` without
// solvation, and the solvation part of `solvated`. The work grows with the number of coordinates
// that move one of their atoms.
void update_pair_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                             std::span<const std::array<std::uint32_t, 2>> pairs,
                             std::span<const std::array<std::uint32_t, 2>> solvated,
                             const NonbondedSettings& settings, const TorsionState& state,
                             SecondDerivatives& derivatives);

}  // namespace palpa
