// Second derivatives along one direction, for systems whose whole matrix is too large.
#pragma once
#include "statics/local_coordinates.h"

#include <Eigen/Core>

namespace palpa {

struct HessianProductSettings {
    ForceSettings forces;
    // Displacement of the farthest atom, Å. 0: the best value, 1e-3 for pairs in double precision
    // and 0.02 for fast ones.
    double move = 0;
};

// The product of all second derivatives and a direction (of all coordinates, including hands), from
// the difference of two gradients, that is, two evaluations of the forces. Error relative to the
// largest entry: about 1e-5 with pairs in double and 1e-2 with fast pairs (rounding); more if a
// pair crosses a cutoff. `trial`: a state of the model, overwritten. Zero for a direction that
// moves nothing.
Eigen::VectorXd find_hessian_product(const TorsionModel& model, const LocalCoordinates& coordinates,
                                     const HessianProductSettings& settings, ForceMemory& memory,
                                     const TorsionState& origin, const Eigen::VectorXd& direction,
                                     TorsionState& trial);

}  // namespace palpa
