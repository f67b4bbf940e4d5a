// Renewals of the model of a second-order step: the state relaxes on the whole energy with hands
// fixed, and is linearised there.
#pragma once
#include "statics/linearised_model.h"
#include "statics/relax_joints.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace palpa {

// With this number of coordinates the dense matrices take 0.4 GB and a renewal about a second; work
// grows with the third power.
inline constexpr Eigen::Index most_second_order_coordinates = 3000;

struct SecondOrderSettings : LineariseSettings {
    double stride = 0.1;  // Å: longest way of a hand between two relaxations
    std::size_t most_strides =
        25;                       // strides in a step; a hand that moves farther makes longer ones
    std::size_t evaluations = 4;  // evaluations of the model after each stride, at most
    double largest_move = 0.15;   // Å, largest move of an atom in one of them
    double rest = 1e-3;  // rms force along coordinates that counts as rest, kcal/mol per rad and Å
    double span_rest = 1e-5;  // the same along combinations of unit curvature, kcal/mol

    // The model is renewed if a hand or an atom has moved this far from the point of linearisation
    // (Å). A stride that moves an atom beyond `farthest` is repeated with a new model.
    double renew_hand = 0.1, renew_atom = 0.3, farthest = 0.45;
    // While a renewal is pending, no hand moves farther than this from the point (Å).
    double farthest_hand = 0.3;
    // If true, renewals take place within the step. Otherwise the step requests them (`pending`)
    // and continues with the old model until the caller adopts them.
    bool renews_at_once = true;
    // After this number of steps with hands at rest everything relaxes by renewals alone, so that
    // the felt force converges to that of the whole energy.
    std::size_t still_steps = 10;

    // Tolerance of the force error, kcal/mol/Å. If set, it replaces `renew_hand`: the model is
    // renewed when the error estimate comes near the tolerance, and evaluations continue, up to
    // three times as many, while the remaining error is above a quarter of it. `near_reach` is then
    // the start value: it grows up to `farthest_reach` while the error of models reaches the
    // tolerance within their region, and shrinks down to `nearest_reach` while it stays far below.
    std::optional<double> tolerance;
    double nearest_reach = 4, farthest_reach = 10;  // Å

    // Relaxation at a renewal: at least this number of evaluations of the whole energy, and more
    // until the rms force is below `relaxed`, at most `most_relaxation`. No step moves an atom
    // farther than `relax_move`.
    std::size_t least_relaxation = 6, most_relaxation = 25;
    double relaxed = 5;       // kcal/mol per rad and Å
    double relax_move = 0.1;  // Å
};

// The longest way of a hand by these coordinates (Å), and the largest force on one (kcal/mol/Å);
// rotations and torques count as at an atom 5 Å from the axis.
double find_farthest_way(std::span<const HandHold> hands, const Eigen::VectorXd& coordinates);
double find_largest_force(std::span<const HandHold> hands, const Eigen::VectorXd& gradient);

// Lower limit of the age in the computation of error growth.
inline constexpr double least_error_age = 0.3;

// Memory reused between renewals. They read nothing else that changes, so another thread may make
// them.
struct RenewalMemory {
    Lineariser lineariser;
    QuasiStatics full;
    std::shared_ptr<const LinearisedModel> last;  // its factor preconditions the next relaxation
};

// The start of a renewal.
struct RenewalRequest {
    TorsionState state;
    double near_reach = 0;  // Å, of the new model; 0: from the settings
    double age = 0;         // age of the old model, in units of its region of validity
    // Gradient at the hands by the old model, and the same if that model were at rest; empty
    // without an old model.
    Eigen::VectorXd felt, at_rest;
    // The old model and its gradient along its own coordinates; null and empty without one. The
    // renewal derives from them how far the model would still have turned the joints, which no step
    // needs.
    std::shared_ptr<const LinearisedModel> old;
    Eigen::VectorXd old_gradient;
};

// A model linearised at a relaxed state.
struct [[nodiscard]] Renewal {
    std::shared_ptr<const LinearisedModel> linear;  // null if something was not finite
    JointRelaxReport relaxed;
    std::uint32_t farthest_atom = 0;  // atom that the relaxation moved farthest
    // Error of the old model's force on the hands, kcal/mol/Å; the part of it due to the model
    // itself and not to incomplete relaxation; and the age of the old model.
    std::optional<double> error;
    double model_error = 0, error_age = 0;
    // The model's own error of each body's joint, rad: how much farther the relaxation turned it
    // than the model would have. Empty without an old model.
    std::vector<double> joint_errors;
};

// Relaxes the state with hands fixed and linearises there.
Renewal make_renewal(const TorsionModel& model, const SecondOrderSettings& settings,
                     RenewalRequest request, RenewalMemory& memory);

}  // namespace palpa
