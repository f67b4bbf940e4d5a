#include "session/lockstep.h"

#include <cstddef>

namespace palpa {

void run_lockstep(const LockstepSettings& settings, std::span<const LockstepHand> hands,
                  const StepHandsFunction& step, const HandTicksFunction& on_ticks,
                  const EndFunction& is_over) {
    const std::size_t count = hands.size();
    std::vector<ServoHand> servos(count);
    std::vector<ContactModel> felt(count);
    std::vector<LocalContactModel> next;
    std::vector<HandPose> poses(count);
    std::vector<ServoTick> ticks(count);
    for (const LockstepHand& hand : hands) next.push_back(hand.first);
    for (std::uint64_t tick = 0; tick < settings.ticks; ++tick) {
        const bool period_begins = tick % settings.ticks_per_step == 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (period_begins) {
                servos[i].settings = hands[i].servo;
                servos[i].exchange.contact.post(next[i]);
                felt[i] = next[i].model;
            }
            servos[i].reading = hands[i].device.read();
        }

        step_servos(servos, static_cast<double>(tick) / servo_rate_hz);
        for (std::size_t i = 0; i < count; ++i) ticks[i] = servos[i].tick;
        on_ticks(ticks);
        for (std::size_t i = 0; i < count; ++i) {
            hands[i].device.show(ticks[i].contact, ticks[i].waiting_m);
            hands[i].device.write(ticks[i].sent_newton);
            servos[i].exchange.hand.read(poses[i]);
        }

        if (period_begins) next = step(poses, felt);
        if (is_over && is_over()) return;
    }
}

void run_lockstep(const LockstepSettings& settings, const ServoSettings& servo, Device& device,
                  const LocalContactModel& first, const StepFunction& step,
                  const TickFunction& on_tick, const EndFunction& is_over) {
    const LockstepHand hand{device, servo, first};
    const auto step_one = [&](std::span<const HandPose> poses, std::span<const ContactModel> felt) {
        std::vector<LocalContactModel> contacts;
        contacts.push_back(step(poses[0], felt[0]));
        return contacts;
    };
    const auto on_one = [&](std::span<const ServoTick> ticks) { on_tick(ticks[0]); };
    run_lockstep(settings, std::span(&hand, 1), step_one, on_one, is_over);
}

}  // namespace palpa
