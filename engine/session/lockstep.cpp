#include "session/lockstep.h"

namespace palpa {

void run_lockstep(const LockstepSettings& settings, const ServoSettings& servo, Device& device,
                  const Touch& first, const StepFunction& step, const TickFunction& on_tick,
                  const EndFunction& is_over) {
    Exchange exchange;
    ServoState state;
    TouchModel felt;
    Touch next = first;
    HandPose hand;
    for (std::uint64_t tick = 0; tick < settings.ticks; ++tick) {
        const bool period_begins = tick % settings.ticks_per_step == 0;
        if (period_begins) {
            exchange.touch.post(next);
            felt = next.model;
        }

        const ServoTick done = step_servo(servo, state, exchange, device.read(),
                                          static_cast<double>(tick) / servo_rate_hz);
        on_tick(done);
        device.show(done.touch);
        device.write(done.sent_newton);

        exchange.hand.read(hand);
        if (period_begins) next = step(hand, felt);
        if (is_over && is_over()) return;
    }
}

}  // namespace palpa
