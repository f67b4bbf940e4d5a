// Renewals of the model of a step by second order: the state relaxes on the whole energy while
// hands stay, and is linearised there.
#pragma once
#include "statics/linearised_model.h"
#include "statics/relax_joints.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace palpa {

// Dense matrices of so many coordinates take 0.4 GB and a renewal about a second; with more the
// work grows with the third power.
inline constexpr Eigen::Index most_second_order_coordinates = 3000;

struct SecondOrderSettings : LineariseSettings {
    double stride = 0.1;            // Å: the way of a hand between two relaxations, at most
    std::size_t most_strides = 25;  // in a step; a hand that goes farther has longer ones
    std::size_t evaluations = 4;    // of the model after each stride, at most
    double largest_move = 0.15;     // Å, of any atom in one of them
    double rest = 1e-3;  // rms force along coordinates that counts as rest, kcal/mol per rad and Å
    double span_rest = 1e-5;  // the same along combinations of curvature one, kcal/mol

    // The model is renewed if a hand or an atom has gone so far from the point of linearisation
    // (Å). A stride that takes an atom beyond `farthest` is repeated with a new model.
    double renew_hand = 0.1, renew_atom = 0.3, farthest = 0.45;
    // While a renewal is pending, no hand goes farther than this from the point (Å).
    double farthest_hand = 0.3;
    // Renewals take place within the step. Otherwise the step asks for them (`pending`) and goes on
    // with the old model until the caller adopts them.
    bool renews_at_once = true;
    // Where hands stand still, after so many steps everything relaxes by renewals alone, so that
    // what is felt comes to the rest of the whole energy.
    std::size_t still_steps = 10;

    // kcal/mol/Å. Where set, it decides instead of `renew_hand`: the model is renewed if the error
    // estimate comes near it, and evaluations go on, up to three times as many, while what they
    // leave is more than a quarter of it. Then `near_reach` is where it begins: it grows up to
    // `farthest_reach` while a model's error comes to the tolerance within the region in which it
    // is to hold, and shrinks down to `nearest_reach` while it stays far below.
    std::optional<double> tolerance;
    double nearest_reach = 4, farthest_reach = 10;  // Å

    // Relaxation at a renewal: at least so many evaluations of the whole energy, and more until
    // the rms force is below `relaxed`, at most `most_relaxation`. No step moves an atom farther
    // than `relax_move`.
    std::size_t least_relaxation = 6, most_relaxation = 25;
    double relaxed = 5;       // kcal/mol per rad and Å
    double relax_move = 0.1;  // Å
};

// The farthest way of a hand by these coordinates (Å), and the largest force on one (kcal/mol/Å);
// turns and torques count as at an atom 5 Å from the axis.
double find_farthest_way(std::span<const HandHold> hands, const Eigen::VectorXd& coordinates);
double find_largest_force(std::span<const HandHold> hands, const Eigen::VectorXd& gradient);

// Errors are counted as of this age at least where their growth is found.
inline constexpr double least_error_age = 0.3;

// What renewals use again from one to the next. They read nothing else that changes, so a thread of
// its own may make them.
struct RenewalMemory {
    Lineariser lineariser;
    QuasiStatics full;
    std::shared_ptr<const LinearisedModel> last;  // its factor preconditions the next relaxation
};

// Where a renewal starts from.
struct RenewalRequest {
    TorsionState state;
    double near_reach = 0;  // Å, of the new model; 0: as the settings have it
    double age = 0;         // of the old model, in units of the region in which it holds
    // Gradient at the hands by the old model, and what it would be if that model were at rest;
    // empty where there is none.
    Eigen::VectorXd felt, at_rest;
    // That model, and its gradient at its own coordinates; null and empty too. From these the
    // renewal finds what the model had yet to turn, which no step needs.
    std::shared_ptr<const LinearisedModel> old;
    Eigen::VectorXd old_gradient;
};

// A model linearised at a relaxed state.
struct [[nodiscard]] Renewal {
    std::shared_ptr<const LinearisedModel> linear;  // none where anything was not finite
    JointRelaxReport relaxed;
    std::uint32_t farthest_atom = 0;  // of those that this moved
    // The force on the hands that the old model had, less the right one, kcal/mol/Å; the part of it
    // that is the model's own, not what it had yet to relax; and the old model's age.
    std::optional<double> error;
    double model_error = 0, error_age = 0;
    // The model's own error of each body's joint, rad: by how much the relaxation turned it beyond
    // what the model had yet to turn it. Empty where there was none.
    std::vector<double> joint_errors;
};

// Relaxes the state while its hands stay, and linearises there.
Renewal make_renewal(const TorsionModel& model, const SecondOrderSettings& settings,
                     RenewalRequest request, RenewalMemory& memory);

}  // namespace palpa
