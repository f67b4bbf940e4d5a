#include "statics/hessian_product.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace palpa {
namespace {

// Of atoms, and of springs' ends.
double find_largest_speed(const TorsionModel& model, const LocalCoordinates& coordinates,
                          const TorsionState& state, const Eigen::VectorXd& direction) {
    std::vector<CoordinateMotion> motions;
    update_motions(model, coordinates, state, motions);
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<Vec6> screws(bodies.size(), Vec6::Zero());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (bodies[b].parent != no_body) screws[b] = screws[bodies[b].parent];
        for (const CarriedCoordinate& carried : coordinates.of(b)) {
            screws[b] += direction[carried.column] *
                         motions[static_cast<std::size_t>(carried.column)].screw_at(Vec3::Zero());
        }
    }
    double largest = 0;
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
        const Vec6& screw = screws[model.tree.bodies.body_of[i]];
        largest =
            std::max(largest, (screw.head<3>().cross(state.positions[i]) + screw.tail<3>()).norm());
    }
    for (const LocalCoordinates::SpringEnd& end : coordinates.ends)
        largest = std::max(largest, direction.segment<3>(end.column).norm());
    return largest;
}

}  // namespace

Eigen::VectorXd find_hessian_product(const TorsionModel& model, const LocalCoordinates& coordinates,
                                     const HessianProductSettings& settings, ForceMemory& memory,
                                     const TorsionState& origin, const Eigen::VectorXd& direction,
                                     TorsionState& trial) {
    constexpr double of_double = 1e-3, of_fast = 0.02;  // Å
    const double move = settings.move > 0          ? settings.move
                        : is_fast(settings.forces) ? of_fast
                                                   : of_double;
    const double speed = find_largest_speed(model, coordinates, origin, direction);
    if (!(speed > 0)) return Eigen::VectorXd::Zero(coordinates.size());
    const double h = move / speed;
    const auto gradient = [&](double by) {
        const Eigen::VectorXd at = by * direction;
        place_about(model, coordinates, origin, at, trial);
        update_forces(model, settings.forces, memory, trial);
        return find_gradient(model, coordinates, origin, at, trial);
    };
    const Eigen::VectorXd ahead = gradient(h);
    return (ahead - gradient(-h)) / (2 * h);
}

}  // namespace palpa
