// Second derivatives along one direction, for systems whose whole matrix is too large.
#pragma once
#include "statics/local_coordinates.h"

#include <Eigen/Core>

namespace palpa {

struct HessianProductSettings {
    ForceSettings forces;
    // Of the farthest atom, Å. With 0, what is best: 1e-3 of pairs in double, 0.02 of fast ones.
    double move = 0;
};

// All second derivatives times a direction (of all coordinates, hands' too), from the difference of
// two gradients: two evaluations of the forces. Against the matrix, of the largest entry: about
// 1e-5 with pairs in double, 1e-2 with fast ones, whose rounding is what limits it; more
// where a pair crosses a cutoff. `trial` is a state of the model, whose content is lost. Zero for
// a direction that moves nothing.
Eigen::VectorXd find_hessian_product(const TorsionModel& model, const LocalCoordinates& coordinates,
                                     const HessianProductSettings& settings, ForceMemory& memory,
                                     const TorsionState& origin, const Eigen::VectorXd& direction,
                                     TorsionState& trial);

}  // namespace palpa
