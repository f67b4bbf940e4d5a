// Few responses of the mobile coordinates in whose span a step seeks the answer to a hand, so that
// its cost follows their number: those to the hands' moves, and to the forces that remain near the
// hands after everything has answered these linearly.
#pragma once
#include "statics/linearised_model.h"

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace palpa {

// At most `count` responses for each hand, by the model's factor, those to the hands themselves in
// any case. The
// forces are the model's, for moves of each hand by 0.1 Å along and between the axes. `mixed`:
// second derivatives of the energy by mobile coordinates and hands.
ResponseSpan build_response_span(const TorsionModel& model, const ForceSettings& settings,
                                 const LinearisedModel& linear, std::span<const HandHold> hands,
                                 const Eigen::MatrixXd& mixed, std::size_t count);

// Writes the model's gradient and rest, which are of all coordinates, in those of its span. In
// single precision stiff coordinates would leave too little of soft combinations, so `rest` has the
// second derivatives in double.
void reduce_to_span(const Eigen::MatrixXd& rest, LinearisedModel& linear);

}  // namespace palpa
