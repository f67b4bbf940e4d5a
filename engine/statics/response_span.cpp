#include "statics/response_span.h"
#include "math/eigenvectors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// Displacements of hands for which a span is made: each coordinate, and two at a time, both ways.
std::vector<Eigen::VectorXd> list_displacements(std::span<const HandHold> hands) {
    constexpr double shift = 0.1;  // Å, of the region in which a model holds
    constexpr double turn = 0.02;  // rad: as far, at an atom 5 Å from the axis
    std::vector<double> sizes;
    for (const HandHold& hand : hands) {
        if (hand.turns) sizes.insert(sizes.end(), 3, turn);
        sizes.insert(sizes.end(), 3, shift);
    }
    const auto count = static_cast<Eigen::Index>(sizes.size());
    const auto along = [&](Eigen::Index c) -> Eigen::VectorXd {
        return sizes[static_cast<std::size_t>(c)] * Eigen::VectorXd::Unit(count, c);
    };
    std::vector<Eigen::VectorXd> displacements;
    const auto add = [&](const Eigen::VectorXd& d) {
        displacements.push_back(d);
        displacements.emplace_back(-d);
    };
    for (Eigen::Index c = 0; c < count; ++c) add(along(c));
    for (Eigen::Index c = 0; c < count; ++c) {
        for (Eigen::Index e = 0; e < c; ++e) add(std::sqrt(0.5) * (along(c) + along(e)));
    }
    return displacements;
}

// What pulls along the mobile coordinates after hands have gone and everything has answered
// linearly, and after each further answer to that: at least `count` columns, in as many rounds as
// that takes.
Eigen::MatrixXd find_remaining_forces(const TorsionModel& model, const ForceSettings& settings,
                                      const LinearisedModel& linear,
                                      std::span<const HandHold> hands, Eigen::Index count) {
    const Eigen::Index mobile = linear.mobile();
    std::vector<Eigen::VectorXd> places;
    places.emplace_back(Eigen::VectorXd::Zero(linear.gradient.size()));
    for (const Eigen::VectorXd& d : list_displacements(hands)) {
        places.emplace_back(linear.gradient.size());
        places.back() << linear.response * d, d;
    }
    const auto tried = static_cast<Eigen::Index>(places.size());
    const Eigen::Index rounds = (count + tried - 1) / tried;
    Eigen::MatrixXd forces(mobile, rounds * tried);
    TorsionState state = linear.at;
    NearPairs near = linear.near;
    ModelValue value;
    for (Eigen::Index round = 0; round < rounds; ++round) {
        for (Eigen::Index i = 0; i < tried; ++i) {
            evaluate_model(model, settings, linear, places[static_cast<std::size_t>(i)], near,
                           state, value);
            forces.col(round * tried + i) = -value.gradient.head(mobile);
        }
        const Eigen::MatrixXd moves =
            find_response(linear.factor, forces.middleCols(round * tried, tried));
        for (Eigen::Index i = 0; i < tried; ++i)
            places[static_cast<std::size_t>(i)].head(mobile) += moves.col(i);
    }
    return forces;
}

// Forces, one column each, and what they move; products: of each force with each move.
struct Responses {
    Eigen::MatrixXd forces, moves, products;

    Responses(const ResponseFactor& factor, Eigen::MatrixXd columns)
        : forces(std::move(columns)), moves(find_response(factor, forces)) {
        const Eigen::MatrixXd all = moves.transpose() * forces;
        products = 0.5 * (all + all.transpose());
    }
};

// Combinations of columns of which each has the curvature one, the most energetic of `most` first
// of all. Those that nearly vanish are left out.
Eigen::MatrixXd find_combinations(const Eigen::MatrixXd& products, Eigen::Index most) {
    if (products.size() == 0) return products;
    constexpr double least = 1e-9;
    const Eigenvectors<Eigen::Dynamic> own = find_eigenvectors(products);
    const Eigen::VectorXd& values = own.values;
    const double bound = least * std::max(values[values.size() - 1], 0.0);
    const auto kept = std::min<Eigen::Index>(
        most, std::ranges::count_if(values, [&](double value) { return value > bound; }));
    return own.vectors.rightCols(kept) * values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

ResponseSpan build_response_span(const TorsionModel& model, const ForceSettings& settings,
                                 const LinearisedModel& linear, std::span<const HandHold> hands,
                                 const Eigen::MatrixXd& mixed, std::size_t count) {
    const Eigen::Index of_hands = mixed.cols();
    // No more than there are coordinates.
    const Eigen::Index all_columns =
        std::min(static_cast<Eigen::Index>(count * hands.size()), mixed.rows());
    const Eigen::Index wanted = std::max<Eigen::Index>(all_columns - of_hands, 0);
    const Eigen::MatrixXd remaining = find_remaining_forces(model, settings, linear, hands, wanted);
    Eigen::MatrixXd forces(mixed.rows(), of_hands + remaining.cols());
    forces << -mixed, remaining;
    const Responses all(linear.factor, std::move(forces));

    // What is beyond the responses to hands.
    const Eigen::Index others = all.products.cols() - of_hands;
    const Eigen::MatrixXd own =
        find_combinations(all.products.topLeftCorner(of_hands, of_hands), of_hands);
    const Eigen::MatrixXd shared = own.transpose() * all.products.topRightCorner(of_hands, others);
    const Eigen::MatrixXd beyond =
        all.products.bottomRightCorner(others, others) - shared.transpose() * shared;
    const Eigen::MatrixXd combined = find_combinations(beyond, wanted);
    ResponseSpan span;
    span.basis.resize(mixed.rows(), own.cols() + combined.cols());
    span.basis.leftCols(own.cols()) = all.moves.leftCols(of_hands) * own;
    span.basis.rightCols(combined.cols()) =
        (all.moves.rightCols(others) - span.basis.leftCols(own.cols()) * shared) * combined;
    span.response = span.basis.transpose() * all.forces.leftCols(of_hands);
    return span;
}

void reduce_to_span(const Eigen::MatrixXd& rest, LinearisedModel& linear) {
    const ResponseSpan& span = *linear.span;
    linear.gradient = span.reduce(linear.gradient);
    linear.rest_gradient = span.reduce(linear.rest_gradient);
    const Eigen::Index n = span.basis.rows(), k = span.basis.cols(), hands = linear.hands();
    Eigen::MatrixXd halfway(n + hands, k + hands);
    halfway.leftCols(k).noalias() = rest.leftCols(n) * span.basis;
    halfway.rightCols(hands) = rest.rightCols(hands);
    linear.rest.resize(k + hands, k + hands);
    linear.rest.topRows(k) = (span.basis.transpose() * halfway.topRows(n)).cast<float>();
    linear.rest.bottomRows(hands) = halfway.bottomRows(hands).cast<float>();
}

}  // namespace palpa
