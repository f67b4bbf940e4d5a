// Second derivatives of the energy along joints, bases and hand coordinates, in double: the
// reference of statics/fast_second_derivatives.h.
#pragma once
#include "forces/pair_hessian.h"
#include "statics/local_coordinates.h"
#include "statics/term_derivatives.h"

#include <Eigen/Core>
#include <cstdint>
#include <span>

namespace palpa {

// kcal/mol per rad and Å: H of the mobile coordinates, G mixed with those of hands, and K of the
// hands' coordinates alone, the stiffness if nothing else moves.
struct SecondDerivatives {
    Eigen::Index mobile = 0;
    Eigen::MatrixXd all;  // mobile coordinates first, then the hands'

    Eigen::Index hands() const noexcept { return all.cols() - mobile; }
    auto of_mobile() const { return all.topLeftCorner(mobile, mobile); }       // H
    auto mixed() const { return all.topRightCorner(mobile, hands()); }         // G
    auto of_hands() const { return all.bottomRightCorner(hands(), hands()); }  // K
};

// All second derivatives at a state, which is the point of linearisation: of every bonded term, of
// every pair with its cutoff, and of the state's springs. They are those of the energy as a
// function of the coordinates of statics/local_coordinates.h. The pairs' part is not symmetrised:
// (a, b) and (b, a) are summed separately and differ by rounding.
//
// The energy depends only on the places of atoms relative to each other. Therefore the second
// derivative along a coordinate b and one that carries it, a, follows from the Hessian blocks
// between the atoms that b moves and those that a does not move. The curvature of the atoms' paths
// is included, and no forces are needed. (After T. Noguti, N. Gō, J. Phys. Soc. Jpn. 52, 3685
// (1983), and H. Abe, W. Braun, T. Noguti, N. Gō, Comput. Chem. 8, 239 (1984).)
void update_second_derivatives(const TorsionModel& model, const LocalCoordinates& coordinates,
                               const ModelPaths& paths, const NonbondedSettings& settings,
                               const TorsionState& state, SecondDerivatives& derivatives);

// What the pair of two atoms, at x_i and x_j from some point, adds to the block of their bodies:
// with T = (-[x]x, 1), which makes a screw about the point the velocity at x, T_i^T (first 1 +
// second d d^T) T_j. It is the negative of the Hessian.
Mat6 pair_block(const Vec3& x_i, const Vec3& x_j, const PairHessian& pair) noexcept;

// One stage of the computation, shared with other forms. `inward` holds for each coordinate the
// transposed blocks of its body and all descendants with all others, times the coordinate's screw
// about the body's point. Adds to half of the second derivatives: the sum with its transpose gives
// all of them.
void add_outward_products(const TorsionModel& model, const LocalCoordinates& coordinates,
                          std::span<const CoordinateMotion> motions, std::span<const Vec3> points,
                          std::span<const Vec6> inward, Eigen::Ref<Eigen::MatrixXd> half);

}  // namespace palpa
