// The quasi-static step by second order: all joints and bases answer the hands at once.
//
// Between renewals the energy is that of statics/linearised_model.h: exact near what hands hold,
// quadratic elsewhere. If a hand moves, everything first follows linearly and then relaxes by
// quasi-Newton steps on that model. Before a hand or an atom leaves the region where the model
// holds, it is renewed: the state relaxes on the whole energy and is linearised again.
#pragma once
#include "statics/renewal.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace palpa {

// A renewal that a step has asked for, until it is used.
struct PendingRenewal {
    RenewalRequest request;
    std::optional<Renewal> made;
};

struct [[nodiscard]] SecondOrderReport {
    bool is_finite = true;  // else the state is where it was at the last renewal, or before
    bool is_renewed = false;
    bool lags = false;        // hands have not come to where they were to go
    double energy = 0;        // kcal/mol, by the model
    double rms_force = 0;     // along the mobile coordinates
    double age = 0;           // Å: the way of the farthest hand from the point of linearisation
    double farthest = 0;      // Å: the same of any atom
    double largest_move = 0;  // Å, of any atom in this step
    std::size_t full_evaluations = 0, model_evaluations = 0;
    std::optional<double> renewal_error;  // of the last one, as in Renewal
    // Of the force on a hand, against complete relaxation (kcal/mol/Å): what the model has not
    // relaxed yet, and the error at the last renewals, which grows with the square of the age.
    double error_estimate = 0;
    // By how much relaxation at renewals lowered the energy, kcal/mol. At a snap, where a minimum
    // has vanished, this is what it sets free.
    double released = 0;
    std::uint32_t farthest_relaxed = 0;  // the atom that it moved farthest
};

// Where a hand has what it moves.
struct HandPlace {
    Vec3 place;  // Å
    Quat turn;
};

// What steps keep from one to the next.
struct SecondOrderStatics {
    RenewalMemory renewals;
    std::optional<PendingRenewal> pending;  // only where renewals do not take place at once

    std::shared_ptr<const LinearisedModel> linear;  // none before the first step
    Eigen::VectorXd at;                             // where the state is, about it
    ModelValue value;                               // of the model there
    CurvaturePairs pairs{false};
    NearPairs near;                   // the model's, with kernel memory of its own
    bool is_settled = true;           // the model's point was relaxed enough
    bool is_at_rest = false;          // the whole energy is, where the hands are
    std::size_t still_steps = 0;      // since hands last moved
    std::vector<HandPlace> still_at;  // where hands were then
    // Of the hands (Å), where this model did not hold any more: until there is another, hands go no
    // farther.
    std::optional<double> refused_way;
    bool is_spent = false;    // this model cannot relax where hands wait
    double error_growth = 0;  // of errors at renewals, kcal/mol/Å per squared age
    double near_reach = 0;    // of the next model, Å, where there is a tolerance
    TorsionState trial;
    ModelValue trial_value;
    std::vector<Vec3> start;  // memory: where the step began

    // For whoever shows them (statics/joint_answers.h); no step reads them. One of each body's
    // joint: by how much it was beyond first order where the last model ended whose hands had
    // moved, rad; and the errors of models at renewals, rad per squared age. Empty before the first
    // renewal.
    std::vector<double> beyond_before, joint_error_growth;

    std::size_t renewed = 0, discarded = 0;  // renewals; strides that were repeated
    std::size_t model_evaluations = 0;
};

SecondOrderStatics build_second_order_statics(const TorsionModel& model, HeldParts held);

// Linearises at the state as it is; without that the first step does, after relaxing.
void start_second_order(const TorsionModel& model, const SecondOrderSettings& settings,
                        const TorsionState& state, SecondOrderStatics& statics);

// Waits for the thread that makes the pending renewal, if there is one.
using AwaitFunction = std::function<void()>;

// Follows the hands to where the state has the bases and spring ends that they move. All other
// coordinates of the state are those of the last step. Where the old model reaches no farther and
// a renewal is pending, hands stay where it reaches. Steps wait for another thread only where
// springs that no hand moves are not as they were.
SecondOrderReport step_second_order(const TorsionModel& model, const SecondOrderSettings& settings,
                                    TorsionState& state, SecondOrderStatics& statics,
                                    const AwaitFunction& await = {});

// Makes the pending renewal where it is not made yet. Another thread may make steps meanwhile;
// nothing may copy or replace the statics.
void make_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                  SecondOrderStatics& statics);

// Makes and adopts it. The new model belongs to where the hands were at the request: the next step
// follows from there to where they are, by strides. One that is not finite changes nothing.
Renewal adopt_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                      SecondOrderStatics& statics);

// How far the state is from the point of linearisation, in units of the region in which the model
// holds.
double find_relative_age(const TorsionModel& model, const SecondOrderSettings& settings,
                         const TorsionState& state, const SecondOrderStatics& statics);

// Torque about the point that a hand moves, zero where it does not turn it, and force, of the model
// on what the hand moves after a step; kcal/mol and kcal/mol/Å.
Vec6 find_hand_pull(const SecondOrderStatics& statics, std::size_t hand) noexcept;

}  // namespace palpa
