// Servo ticks and simulation steps on a virtual clock, in a fixed order: runs repeat to the bit.
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
    std::uint64_t ticks_per_step = 1;  // the declared period of the simulation
};

// One of several hands, with its own device; its slot is its place in the list. What a step changes
// of its servo holds from the next period on.
struct LockstepHand {
    Device& device;
    ServoSettings servo;
    LocalContactModel first;  // felt during the first period
};

// Answers the poses of all hands, with one contact model for each; `felt` are the contact models
// that they feel meanwhile.
using StepHandsFunction = std::function<std::vector<LocalContactModel>(
    std::span<const HandPose>, std::span<const ContactModel> felt)>;
using HandTicksFunction = std::function<void(std::span<const ServoTick>)>;
using EndFunction = std::function<bool()>;

// Tick j reads the devices, runs the servo for all hands and writes the forces. Where a period
// begins, the result of the step before is published first, and a new step starts from this tick's
// hand poses: what it finds is felt from the next period on and held throughout (the paper's z^-1
// and hold). Ends sooner where `is_over`, asked after every tick, says so.
void run_lockstep(const LockstepSettings& settings, std::span<const LockstepHand> hands,
                  const StepHandsFunction& step, const HandTicksFunction& on_ticks,
                  const EndFunction& is_over = {});

using StepFunction =
    std::function<LocalContactModel(const HandPose& hand, const ContactModel& felt)>;
using TickFunction = std::function<void(const ServoTick& tick)>;

// The same of one hand.
void run_lockstep(const LockstepSettings& settings, const ServoSettings& servo, Device& device,
                  const LocalContactModel& first, const StepFunction& step,
                  const TickFunction& on_tick, const EndFunction& is_over = {});

}  // namespace palpa
