// How single joints answer in steps by second order: beyond first order, and how far from right.
#pragma once
#include "statics/second_order_step.h"

#include <vector>

namespace palpa {

// By how much each body's joint differs from the linear answer to the hands' move since the
// linearisation, rad: what relaxation on the model has added. Of the model now and of the last one
// that ended after hands had moved the larger, so that it can be seen where hands stand still and
// renewals follow each other. 0 of bases, and of everything before the first step.
std::vector<double> find_beyond_first_order(const TorsionModel& model,
                                            const SecondOrderStatics& statics);

// Estimated error of each body's joint against complete relaxation, rad, never below 0: what the
// model has yet to turn it, and the model's own error at the last renewals, which grows with the
// square of the age. That a minimum is about to vanish, so that relaxation goes far from here, it
// cannot know. 0 as above. `state`: where the last step left it.
std::vector<double> estimate_joint_errors(const TorsionModel& model,
                                          const SecondOrderSettings& settings,
                                          const TorsionState& state,
                                          const SecondOrderStatics& statics);

// -H^-1 g of the model: what it would yet turn each body's joint before it is at rest, rad.
std::vector<double> find_unrelaxed_turns(const TorsionModel& model,
                                         const SecondOrderStatics& statics);

// Before a renewal is used, of the model that ends with it.
void note_joint_answers(const TorsionModel& model, const SecondOrderSettings& settings,
                        const Renewal& renewal, SecondOrderStatics& statics);

}  // namespace palpa
