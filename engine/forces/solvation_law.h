// EEF1's pair law (field/solvation_law.h) with the parameters of a topology.
#pragma once
#include "charmm/solvation.h"
#include "field/solvation_law.h"

#include <cstddef>

namespace palpa {

inline SolvationAtom solvation_atom(const Solvation& solvation, std::size_t atom) noexcept {
    constexpr double half_pi_power = 0.08979356106258327;  // 1/(2 pi^(3/2))
    const double dg_free = solvation.dg_free[atom], lambda = solvation.lambda[atom];
    if (dg_free == 0) return {solvation.volume[atom], 0, 0, 0};
    return {solvation.volume[atom], half_pi_power * dg_free / lambda, 1 / lambda,
            solvation.radius[atom]};
}

}  // namespace palpa
