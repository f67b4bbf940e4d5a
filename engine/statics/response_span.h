// A small set of responses of the mobile coordinates that spans the solution of a step, so that the
// cost of the step follows their number: the responses to the hands' moves, and those to the forces
// that remain near the hands after the linear response.
#pragma once
#include "statics/linearised_model.h"

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace palpa {

// At most `count` responses per hand by the model's factor, always including those to the hands
// themselves. The forces are the model's, for moves of each hand by 0.1 Å along and between the
// axes. `mixed`: second derivatives of the energy by mobile coordinates and hands.
ResponseSpan build_response_span(const TorsionModel& model, const ForceSettings& settings,
                                 const LinearisedModel& linear, std::span<const HandHold> hands,
                                 const Eigen::MatrixXd& mixed, std::size_t count);

// Transforms the model's gradient and rest from all coordinates to those of its span. `rest` has
// the second derivatives in double, because single precision would lose soft combinations beside
// stiff coordinates.
void reduce_to_span(const Eigen::MatrixXd& rest, LinearisedModel& linear);

}  // namespace palpa
