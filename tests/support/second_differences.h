// Second derivatives from differences of the gradient, which knows nothing of them.
#pragma once
#include "statics/second_derivatives.h"

#include <span>
#include <string>
#include <vector>

namespace palpa::test {

// Columns of the Hessian of all coordinates, one after the other: of the gradient where place_about
// puts the state, differences of fourth order over moves of an atom of 1e-3 Å at most. Forces are
// those of the double sums.
Eigen::MatrixXd difference_columns(const TorsionModel& model, const LocalCoordinates& coordinates,
                                   const NonbondedSettings& settings, const TorsionState& origin,
                                   std::span<const Eigen::Index> columns);

// The largest difference of an entry of these columns, against the largest of its row in `all`; a
// row of nothing but rounding is held against the largest of all.
double worst_of_row(const Eigen::MatrixXd& all, const Eigen::MatrixXd& differences,
                    std::span<const Eigen::Index> columns);

// The largest difference of an entry from its mirror image, against the largest of all.
double worst_asymmetry(const Eigen::MatrixXd& all);

// Every step-th of so many, and the last.
std::vector<Eigen::Index> every(Eigen::Index step, Eigen::Index count);

}  // namespace palpa::test
