#include "statics/response_factor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace palpa {
namespace {

// Sum over a body's atoms, and over all that hang on it, of squares of what a screw about the
// origin moves them by.
std::vector<Mat6> find_inertias(const TorsionModel& model, const TorsionState& state) {
    constexpr double of_turn = 0.1;  // Å^2
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<Mat6> inertias(bodies.size(), Mat6::Zero());
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
        Mat6& inertia = inertias[model.tree.bodies.body_of[i]];
        const Mat3 X = cross_matrix(state.positions[i]);
        inertia.topLeftCorner<3, 3>() += X.transpose() * X + of_turn * Mat3::Identity();
        inertia.topRightCorner<3, 3>() += X;
        inertia.bottomLeftCorner<3, 3>() -= X;
        inertia.bottomRightCorner<3, 3>() += Mat3::Identity();
    }
    for (std::size_t b = bodies.size(); b-- > 0;) {
        if (bodies[b].parent != no_body) inertias[bodies[b].parent] += inertias[b];
    }
    return inertias;
}

constexpr double least_pivot = 1e-10;  // of what stood there: less is rounding

constexpr double growth = 6;    // of a shift that was too small, at least
constexpr double margin = 1.5;  // beyond the curvature that is known to be there

// Of single coordinates, kcal/mol/Å^2.
double find_least_curvature(const Eigen::Ref<const Eigen::MatrixXd>& H, const AtomMetric& metric) {
    double least = 0;
    for (const AtomMetric::Entry& entry : metric.entries) {
        if (entry.row == entry.column)
            least = std::min(least, H(entry.row, entry.row) / entry.value);
    }
    return least;
}

}  // namespace

double AtomMetric::square_of(const Eigen::VectorXd& move) const noexcept {
    double sum = 0;
    for (const Entry& entry : entries) {
        const double product = entry.value * move[entry.row] * move[entry.column];
        sum += entry.row == entry.column ? product : 2 * product;
    }
    return sum;
}

void update_atom_metric(const TorsionModel& model, const LocalCoordinates& coordinates,
                        const TorsionState& state, AtomMetric& metric) {
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    const std::vector<Mat6> inertias = find_inertias(model, state);
    std::vector<CoordinateMotion> motions;
    update_motions(model, coordinates, state, motions);
    std::vector<Vec6> screws;
    for (const CoordinateMotion& motion : motions) screws.push_back(motion.screw_at(Vec3::Zero()));
    metric.entries.clear();
    const auto is_mobile = [&](const CarriedCoordinate& carried) {
        return carried.column < coordinates.mobile;
    };
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const std::span<const CarriedCoordinate> own = coordinates.of(b);
        for (std::size_t i = 0; i < own.size(); ++i) {
            if (!is_mobile(own[i])) continue;
            const Vec6 momentum = inertias[b] * screws[static_cast<std::size_t>(own[i].column)];
            const auto add = [&](const CarriedCoordinate& other) {
                if (!is_mobile(other)) return;
                const double value = momentum.dot(screws[static_cast<std::size_t>(other.column)]);
                const auto [low, high] = std::minmax(own[i].column, other.column);
                metric.entries.push_back({high, low, value});
            };
            for (std::size_t j = i; j < own.size(); ++j) add(own[j]);
            for (std::uint32_t a = bodies[b].parent; a != no_body; a = bodies[a].parent) {
                for (const CarriedCoordinate& outer : coordinates.of(a)) add(outer);
            }
        }
    }
}

bool update_response_factor(const SecondDerivatives& derivatives, const AtomMetric& metric,
                            const FactorSettings& settings, ResponseFactor& factor) {
    const auto H = derivatives.of_mobile();
    const double before = std::exchange(factor.shift, 0.0);
    factor.negative = 0;
    std::optional<CholeskyFailure> failure = update_cholesky(H, least_pivot, factor.cholesky);
    for (factor.tries = 1; failure; ++factor.tries) {
        if (!std::isfinite(failure->value) || factor.tries >= settings.most_tries) return false;
        const Eigen::VectorXd direction = find_direction(factor.cholesky, *failure);
        const double below =
            factor.shift - std::min(0.0, failure->value / metric.square_of(direction));
        factor.shift = std::max({settings.least_shift, growth * factor.shift, margin * below});
        if (factor.tries == 1) {
            factor.shift = std::max(
                {factor.shift, before / growth, -margin * find_least_curvature(H, metric)});
        }
        factor.negative.reset();
        factor.shifted = H;
        for (const AtomMetric::Entry& entry : metric.entries)
            factor.shifted(entry.row, entry.column) += factor.shift * entry.value;
        failure = update_cholesky(factor.shifted, least_pivot, factor.cholesky);
    }
    return true;
}

Eigen::MatrixXd find_response(const ResponseFactor& factor, Eigen::MatrixXd forces) {
    solve_cholesky(factor.cholesky, forces);
    return forces;
}

Eigen::MatrixXd find_relaxed_stiffness(const SecondDerivatives& derivatives,
                                       const ResponseFactor& factor) {
    return derivatives.of_hands() -
           derivatives.mixed().transpose() * find_response(factor, derivatives.mixed());
}

}  // namespace palpa
