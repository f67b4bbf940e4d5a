// Runs servo ticks and simulation steps on a virtual clock in a fixed order, so that runs repeat to
// the bit.
#pragma once
#include "haptics/device.h"
#include "haptics/exchange.h"
#include "haptics/servo.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace palpa {

struct LockstepSettings {
    std::uint64_t ticks = 10000;       // of the servo, 1 ms each
    std::uint64_t ticks_per_step = 1;  // the period of the simulation, in ticks
};

// One of several hands with its own device; its slot is its index in the list. Changes that a step
// makes to its servo hold from the next period on.
struct LockstepHand {
    Device& device;
    ServoSettings servo;
    LocalContactModel first;  // felt during the first period
};

// Returns one contact model for each hand, from the poses of all hands; `felt` are the contact
// models in force meanwhile.
using StepHandsFunction = std::function<std::vector<LocalContactModel>(
    std::span<const HandPose>, std::span<const ContactModel> felt)>;
using HandTicksFunction = std::function<void(std::span<const ServoTick>)>;
using EndFunction = std::function<bool()>;

// Tick j reads the devices, runs the servo of every hand and writes the forces. At the start of a
// period the result of the step before is published, then a new step starts from the hand poses of
// this tick. The hand feels that step's result from the next period on, held constant: z^-1 and
// hold as in the paper. Ends early once `is_over`, called after every tick, returns true.
void run_lockstep(const LockstepSettings& settings, std::span<const LockstepHand> hands,
                  const StepHandsFunction& step, const HandTicksFunction& on_ticks,
                  const EndFunction& is_over = {});

using StepFunction =
    std::function<LocalContactModel(const HandPose& hand, const ContactModel& felt)>;
using TickFunction = std::function<void(const ServoTick& tick)>;

// The same for one hand.
void run_lockstep(const LockstepSettings& settings, const ServoSettings& servo, Device& device,
                  const LocalContactModel& first, const StepFunction& step,
                  const TickFunction& on_tick, const EndFunction& is_over = {});

}  // namespace palpa
