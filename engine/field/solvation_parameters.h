// EEF1's solvation parameters of a set of points.
#pragma once
#include <span>

namespace palpa {

// One entry per atom; what one takes of another's water (EEF1) is
//   strength volume' exp(-((r - radius)/lambda)^2)/r^2.
// All empty where there is no solvation.
struct SolvationParameters {
    std::span<const double> volume;          // Å^3
    std::span<const double> strength;        // kcal/mol/Å
    std::span<const double> inverse_lambda;  // 1/Å
    std::span<const double> radius;          // Å
};

}  // namespace palpa
