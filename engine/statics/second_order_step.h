// The second-order quasi-static step: all joints and bases respond to the hands at once.
// Between renewals the energy is that of statics/linearised_model.h: exact near what hands hold,
// quadratic elsewhere. When a hand moves, everything first follows linearly and then relaxes by
// quasi-Newton steps on that model. Before a hand or an atom leaves the region in which the model
// is valid, the model is renewed: the state relaxes on the whole energy and is linearised again.
#pragma once
#include "statics/renewal.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace palpa {

// A renewal requested by a step and not used yet.
struct PendingRenewal {
    RenewalRequest request;
    std::optional<Renewal> made;
};

struct [[nodiscard]] SecondOrderReport {
    bool is_finite = true;  // if false, the state is that of the last renewal or an earlier one
    bool is_renewed = false;
    bool lags = false;        // hands have not reached their targets
    double energy = 0;        // kcal/mol, energy of the model
    double rms_force = 0;     // along the mobile coordinates
    double age = 0;           // Å: largest distance of a hand from the point of linearisation
    double farthest = 0;      // Å: largest distance of an atom from it
    double largest_move = 0;  // Å, of any atom in this step
    std::size_t full_evaluations = 0, model_evaluations = 0;
    std::optional<double> renewal_error;  // error at the last renewal, as in Renewal
    // Estimated error of the force on a hand against complete relaxation (kcal/mol/Å): what the
    // model has not relaxed yet, plus the error at the last renewals, which grows with the square
    // of the age.
    double error_estimate = 0;
    // Energy released by relaxation at renewals, kcal/mol. Large at a snap, where a minimum has
    // vanished.
    double released = 0;
    std::uint32_t farthest_relaxed = 0;  // atom that this relaxation moved farthest
};

// Position and rotation of what a hand moves.
struct HandPlace {
    Vec3 place;  // Å
    Quat turn;
};

// The factor by which the region of a model is wider if the hand waited at the end of the last one,
// because it is faster than renewals. Makes fewer renewals, each with a larger error. Only used if
// renewals do not take place at once.
inline constexpr double wider_for_fast_hands = 2;

// State that steps carry over from one to the next.
struct SecondOrderStatics {
    RenewalMemory renewals;
    std::optional<PendingRenewal> pending;  // only used if renewals do not take place at once

    std::shared_ptr<const LinearisedModel> linear;  // null before the first step
    Eigen::VectorXd at;                             // coordinates of the state about it
    ModelValue value;                               // value of the model there
    CurvaturePairs pairs{false};
    NearPairs near;          // near pairs of the model, with separate kernel memory
    bool is_settled = true;  // the point of the model was relaxed enough
    bool is_at_rest =
        false;  // the whole energy is at a minimum with the hands at their present positions
    std::size_t still_steps = 0;      // steps since hands last moved
    std::vector<HandPlace> still_at;  // positions of the hands then
    // Way of the hands (Å) at which this model became invalid: until the next model, hands move no
    // farther.
    std::optional<double> refused_way;
    // The hand waited at the end of the region of the model before, so it goes on with this one;
    // and the steps since this model is used.
    bool hand_waited = false;
    std::size_t steps_with_model = 0;
    bool is_spent = false;    // this model cannot relax at the waiting position of the hands
    double error_growth = 0;  // growth of errors at renewals, kcal/mol/Å per squared age
    double near_reach = 0;    // of the next model, Å, with a tolerance
    TorsionState trial;
    ModelValue trial_value;
    std::vector<Vec3> start;  // memory: positions at the start of the step

    // For display (statics/joint_answers.h); steps do not read them. One entry per body's joint:
    // its angle beyond first order at the end of the last model whose hands had moved, rad; and the
    // errors of models at renewals, rad per squared age. Empty before the first renewal.
    std::vector<double> beyond_before, joint_error_growth;

    std::size_t renewed = 0, discarded = 0;  // number of renewals; number of repeated strides
    std::size_t model_evaluations = 0;
};

// How far a hand may be from the point of linearisation now (Å).
double find_farthest_hand(const SecondOrderSettings& settings,
                          const SecondOrderStatics& statics) noexcept;

SecondOrderStatics build_second_order_statics(const TorsionModel& model, HeldParts held);

// Linearises at the state as it is. Without this call the first step does so after relaxing.
void start_second_order(const TorsionModel& model, const SecondOrderSettings& settings,
                        const TorsionState& state, SecondOrderStatics& statics);

// Waits for the thread that makes the pending renewal, if there is one.
using AwaitFunction = std::function<void()>;

// Follows the hands to the positions that the state has for the bases and spring ends that they
// move. All other coordinates of the state are those of the last step. If the old model is valid no
// farther and a renewal is pending, hands stop at the limit. Steps wait for another thread only if
// springs that no hand moves have changed.
SecondOrderReport step_second_order(const TorsionModel& model, const SecondOrderSettings& settings,
                                    TorsionState& state, SecondOrderStatics& statics,
                                    const AwaitFunction& await = {});

// Makes the pending renewal if it is not made yet. Another thread may make steps meanwhile; nothing
// may copy or replace the statics.
void make_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                  SecondOrderStatics& statics);

// Makes and adopts the pending renewal. The new model belongs to the positions of the hands at the
// request: the next step follows from there to the present ones by strides. A renewal that is not
// finite changes nothing.
Renewal adopt_pending(const TorsionModel& model, const SecondOrderSettings& settings,
                      SecondOrderStatics& statics);

// Distance of the state from the point of linearisation, in units of the region in which the model
// is valid.
double find_relative_age(const TorsionModel& model, const SecondOrderSettings& settings,
                         const TorsionState& state, const SecondOrderStatics& statics);

// Torque about the hand's point (zero if the hand does not turn what it holds) and force of the
// model on what the hand moves, after a step; kcal/mol and kcal/mol/Å.
Vec6 find_hand_pull(const SecondOrderStatics& statics, std::size_t hand) noexcept;

}  // namespace palpa
