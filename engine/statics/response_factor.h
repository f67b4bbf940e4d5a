// The response of coordinates to forces: a factor of their second derivatives that exists in every
// state, also where H is indefinite because a side chain is about to snap.
#pragma once
#include "field/cholesky.h"
#include "statics/second_derivatives.h"

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace palpa {

// The sum of squared atom moves as a quadratic form of the mobile coordinates, J^T J: it makes
// radians and Å comparable. Each turn adds 0.1 Å^2 for every atom that it moves, so that the form
// is positive definite even where atoms lie on the axis. Entries are zero unless one coordinate
// carries the other; those are left out.
struct AtomMetric {
    struct Entry {
        Eigen::Index row, column;  // row >= column
        double value;
    };
    std::vector<Entry> entries;

    double square_of(const Eigen::VectorXd& move) const noexcept;
};

void update_atom_metric(const TorsionModel& model, const LocalCoordinates& coordinates,
                        const TorsionState& state, AtomMetric& metric);

struct FactorSettings {
    // kcal/mol/Å^2, smallest nonzero shift: as if a spring of this constant held each atom
    double least_shift = 1e-4;
    std::size_t most_tries = 30;
};

// Cholesky factor of H, or, if H is not positive definite, of H + shift M with the metric M.
// (Factors with negative pivots raised, or L D L^T with the signs of D changed, take one pass. Both
// were tried: with a pivot near zero they give moves thousands of times too large.)
struct ResponseFactor {
    CholeskyFactor cholesky;
    double shift = 0;       // kcal/mol/Å^2
    std::size_t tries = 0;  // factorisations, including failed ones
    // Number of directions of negative curvature: 0 without a shift, else unknown.
    std::optional<std::size_t> negative = 0;
    Eigen::MatrixXd shifted;  // memory
};

// Returns false if H is not finite. A failed try yields a direction of negative curvature; the next
// shift makes that curvature positive and is at least six times the previous shift. The first shift
// is a sixth of the factor's last one, since successive states are similar.
[[nodiscard]] bool update_response_factor(const SecondDerivatives& derivatives,
                                          const AtomMetric& metric, const FactorSettings& settings,
                                          ResponseFactor& factor);

// The moves that balance the given forces, one column each: (H + shift M)^-1 times the forces.
Eigen::MatrixXd find_response(const ResponseFactor& factor, Eigen::MatrixXd forces);

// The stiffness at the hands with everything mobile relaxed, the Schur complement K - G^T H^-1 G
// (with H + shift M for H). kcal/mol per Å and rad; not symmetrised.
Eigen::MatrixXd find_relaxed_stiffness(const SecondDerivatives& derivatives,
                                       const ResponseFactor& factor);

}  // namespace palpa
