#include "tests/support/second_differences.h"

#include "statics/step_quasi_static.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa::test {
namespace {

// The largest of a row; where that is rounding, since nothing pulls at the coordinate, of all.
double scale_of(const Eigen::MatrixXd& all, Eigen::Index row) {
    const double of_row = all.row(row).cwiseAbs().maxCoeff(), of_all = all.cwiseAbs().maxCoeff();
    return of_row > 1e-10 * of_all ? of_row : of_all;
}

double largest_speed(const TorsionModel& model, const LocalCoordinates& coordinates,
                     const TorsionState& origin, Eigen::Index column) {
    constexpr double small = 1e-6;
    TorsionState state = origin;
    place_about(model, coordinates, origin,
                small * Eigen::VectorXd::Unit(coordinates.size(), column), state);
    return find_largest_move(origin.positions, state.positions) / small;
}

}  // namespace

Eigen::MatrixXd difference_columns(const TorsionModel& model, const LocalCoordinates& coordinates,
                                   const NonbondedSettings& settings, const TorsionState& origin,
                                   std::span<const Eigen::Index> columns) {
    Eigen::MatrixXd result(coordinates.size(), static_cast<Eigen::Index>(columns.size()));
    TorsionState state = origin;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        const double h =
            1e-3 / std::max(1.0, largest_speed(model, coordinates, origin, columns[c]));
        const auto gradient = [&](double by) {
            const Eigen::VectorXd at = by * Eigen::VectorXd::Unit(coordinates.size(), columns[c]);
            ForceMemory memory;
            place_about(model, coordinates, origin, at, state);
            update_forces(model, {.nonbonded = settings}, memory, state);
            return find_gradient(model, coordinates, origin, at, state);
        };
        const Eigen::VectorXd near = gradient(h) - gradient(-h);
        const Eigen::VectorXd far = gradient(2 * h) - gradient(-2 * h);
        result.col(static_cast<Eigen::Index>(c)) = (8 * near - far) / (12 * h);
    }
    return result;
}

double worst_of_row(const Eigen::MatrixXd& all, const Eigen::MatrixXd& differences,
                    std::span<const Eigen::Index> columns) {
    double worst = 0;
    for (Eigen::Index row = 0; row < all.rows(); ++row) {
        const double largest = scale_of(all, row);
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const double off =
                std::abs(all(row, columns[c]) - differences(row, static_cast<Eigen::Index>(c)));
            if (!(off <= worst * largest)) worst = off / largest;
        }
    }
    return worst;
}

double worst_asymmetry(const Eigen::MatrixXd& all) {
    return (all - all.transpose()).cwiseAbs().maxCoeff() / all.cwiseAbs().maxCoeff();
}

std::vector<Eigen::Index> every(Eigen::Index step, Eigen::Index count) {
    std::vector<Eigen::Index> result;
    for (Eigen::Index i = 0; i < count - 1; i += step) result.push_back(i);
    result.push_back(count - 1);
    return result;
}

}  // namespace palpa::test
