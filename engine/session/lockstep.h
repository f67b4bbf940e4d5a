// Servo ticks and simulation steps on a virtual clock, in a fixed order: runs repeat to the bit.
#pragma once
#include "haptics/device.h"
#include "haptics/exchange.h"
#include "haptics/servo.h"

#include <cstdint>
#include <functional>

namespace palpa {

struct LockstepSettings {
    std::uint64_t ticks = 10000;       // of the servo, 1 ms each
    std::uint64_t ticks_per_step = 1;  // the declared period of the simulation
};

// Answers a hand pose; `felt` is the touch model that the hand feels meanwhile.
using StepFunction = std::function<Touch(const HandPose& hand, const TouchModel& felt)>;
using TickFunction = std::function<void(const ServoTick& tick)>;
using EndFunction = std::function<bool()>;

// Tick j reads the device, runs the servo and writes the force. Where a period begins, the result
// of the step before is published first, and a new step starts from this tick's hand pose: what it
// finds is felt from the next period on and held throughout (the paper's z^-1 and hold). `first` is
// felt during the first period. Ends sooner where `is_over`, asked after every tick, says so.
void run_lockstep(const LockstepSettings& settings, const ServoSettings& servo, Device& device,
                  const Touch& first, const StepFunction& step, const TickFunction& on_tick,
                  const EndFunction& is_over = {});

}  // namespace palpa
