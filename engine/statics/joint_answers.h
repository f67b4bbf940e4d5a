// Response of single joints in second-order steps: nonlinear part and estimated error.
#pragma once
#include "statics/second_order_step.h"

#include <vector>

namespace palpa {

// Returns one angle per body, rad: by how much its joint differs from the linear answer to the
// hands' move since the linearisation. This is what relaxation on the model has added. Two models
// count: the one now, and the last one that ended after hands had moved. The larger angle is
// returned, so that it can be seen while hands stand still and renewals follow each other. It is 0
// for bases, and for everything before the first step.
std::vector<double> find_beyond_first_order(const TorsionModel& model,
                                            const SecondOrderStatics& statics);

// Returns one estimated error per body, rad, never below 0: how far its joint is from where
// complete relaxation would turn it. The estimate has two parts: what the model has yet to turn the
// joint, and the error that the model itself had at the last renewals, which grows with the square
// of its age. The estimate cannot know that a minimum is about to vanish, so that relaxation goes
// far. It is 0 for bases, and before the first step. `state`: where the last step left it.
std::vector<double> estimate_joint_errors(const TorsionModel& model,
                                          const SecondOrderSettings& settings,
                                          const TorsionState& state,
                                          const SecondOrderStatics& statics);

// Returns one angle per body, rad: how far the model would still turn its joint until the model is
// at rest, -H^-1 g. `gradient`: of the model, along its own coordinates.
std::vector<double> find_unrelaxed_turns(const TorsionModel& model, const LinearisedModel& linear,
                                         const Eigen::VectorXd& gradient);

// Stores what the functions above need of the model that this renewal replaces. Call it before the
// renewal is used.
void note_joint_answers(const TorsionModel& model, const SecondOrderSettings& settings,
                        const Renewal& renewal, SecondOrderStatics& statics);

}  // namespace palpa
