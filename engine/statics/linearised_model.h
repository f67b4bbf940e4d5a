// The energy about a point of linearisation: exact for pairs between held atoms and atoms near
// them, and to second order for everything else.
#pragma once
#include "statics/close_pairs.h"
#include "statics/fast_second_derivatives.h"
#include "statics/local_coordinates.h"
#include "statics/near_pairs.h"
#include "statics/response_factor.h"
#include "statics/torsion_state.h"

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// The atoms and coordinates that hands hold.
struct HeldParts {
    std::vector<HandHold> hands;
    std::vector<std::uint32_t> atoms;  // of all hands, ascending
};

// A few combinations of the mobile coordinates in which a model responds, instead of all
// (statics/response_span.h). With respect to the factored second derivatives each has the curvature
// 1 kcal/mol, and mixed derivatives are zero.
struct ResponseSpan {
    Eigen::MatrixXd basis;     // one column per combination
    Eigen::MatrixXd response;  // X in the span: basis * response is LinearisedModel::response

    // Projects a gradient along all coordinates, hands last, on the span.
    Eigen::VectorXd reduce(const Eigen::VectorXd& gradient) const;
    // Returns all coordinates for those of the span, hands last.
    Eigen::VectorXd expand(const Eigen::VectorXd& at) const;
};

// E(q, d) = E_near(q, d) + Q(q, d), where q are the mobile coordinates and d those of the hands,
// both 0 at the point of linearisation (statics/local_coordinates.h). Q is the Taylor expansion to
// second order of all terms but the near pairs. With a span q are its combinations: then `at`,
// gradients and matrices of the model have those for the mobile coordinates. Not changed after it
// is built.
struct LinearisedModel {
    TorsionState at;  // the point of linearisation, with its energy
    LocalCoordinates coordinates;
    Eigen::VectorXd gradient;  // of the whole energy there; hands last: minus the forces on them
    NearPairs near;
    ClosePairs close;  // close pairs that Q contains

    // Second derivatives of Q at the point. Single precision is enough for the product with a small
    // move.
    double rest_energy = 0;  // kcal/mol
    Eigen::VectorXd rest_gradient;
    Eigen::MatrixXf rest;

    ResponseFactor factor;     // of H, made positive definite
    Eigen::MatrixXd response;  // X = -H^-1 G: moves of mobile coordinates per move of the hands
    std::optional<ResponseSpan> span;
    // At the hands (kcal/mol per Å and rad): K - G^T H^-1 G if everything mobile relaxes, and K if
    // nothing does.
    Eigen::MatrixXd relaxed_stiffness, frozen_stiffness;

    Eigen::Index mobile() const noexcept { return span ? span->basis.cols() : coordinates.mobile; }
    Eigen::Index hands() const noexcept { return coordinates.hands; }
    // X, and H^-1 times forces, in the coordinates of the model.
    const Eigen::MatrixXd& answer() const noexcept { return span ? span->response : response; }
    Eigen::VectorXd balance(const Eigen::VectorXd& forces) const;
};

// Moves the state to these coordinates of a model.
void place_by(const TorsionModel& model, const LinearisedModel& linear, const Eigen::VectorXd& at,
              TorsionState& state);

// Memory and settings reused between linearisations of one model with its hands.
struct Lineariser {
    HeldParts held;
    LocalCoordinates coordinates;
    FastSecondDerivatives fast;
    SecondDerivativesMemory memory;
    SecondDerivatives all, near;
    Eigen::MatrixXd rest;  // second derivatives without the near pairs
    AtomMetric metric;
    double shift = 0;  // shift of the last factor
};

Lineariser build_lineariser(const TorsionModel& model, HeldParts held);

struct LineariseSettings {
    ForceSettings forces;
    double near_reach = 6;  // Å: pairs of held atoms with atoms within this distance are exact
    // The number of responses per hand that span the solution; unset: all coordinates.
    std::optional<std::size_t> responses;
};

// Linearises at a state with forces. Returns false, with an unusable `linear`, if second
// derivatives are not finite.
[[nodiscard]] bool linearise(const TorsionModel& model, const LineariseSettings& settings,
                             const TorsionState& state, Lineariser& lineariser,
                             LinearisedModel& linear);

// Displacement of each of these atoms if everything follows a displaced hand: column c of its
// matrix per Å of the hand's displacement along axis c. `first`: index of the first of the hand's
// three displacements among all hands' coordinates. `state`: the present state, near the model's
// point.
std::vector<Mat3> find_atom_responses(const TorsionModel& model, const LinearisedModel& linear,
                                      const TorsionState& state, Eigen::Index first,
                                      std::span<const std::uint32_t> atoms);

// The model's energy (kcal/mol) and gradient (kcal/mol per rad and Å).
struct ModelValue {
    double energy = 0;
    Eigen::VectorXd gradient;  // of all coordinates, hands last
};

// Places `state` at these coordinates and evaluates the model there. `near` is a copy of the
// model's near pairs, since the kernel writes to its memory. The state's forces are then those of
// the near pairs alone.
void evaluate_model(const TorsionModel& model, const ForceSettings& settings,
                    const LinearisedModel& linear, const Eigen::VectorXd& at, NearPairs& near,
                    TorsionState& state, ModelValue& value);
// The same where the state is there already.
void evaluate_placed(const TorsionModel& model, const ForceSettings& settings,
                     const LinearisedModel& linear, const Eigen::VectorXd& at, NearPairs& near,
                     TorsionState& state, ModelValue& value);

}  // namespace palpa
