#include "session/servo_bank.h"

#include "core/assertion.h"

#include <algorithm>

namespace palpa {

ServoBank::ServoBank(std::size_t hands) : hands_(hands), inputs_(hands), ticks_(hands) {
    PALPA_ASSERT(hands > 0 && hands <= most_hands);
}

void ServoBank::take_orders() noexcept {
    for (std::size_t i = 0; i < hands_.size(); ++i) {
        auto& [orders, order] = inputs_[i];
        const std::uint32_t restarts = order.restarts;
        if (orders.read(order) && order.restarts != restarts) release(hands_[i].state.safety);
    }
}

bool ServoBank::is_paused() const noexcept {
    return std::ranges::all_of(inputs_, [](const Input& input) { return input.order.is_paused; });
}

void ServoBank::tick(std::span<const DeviceReading> readings, double now_s,
                     bool is_ending) noexcept {
    for (std::size_t i = 0; i < hands_.size(); ++i) {
        hands_[i].settings = inputs_[i].order.settings;
        hands_[i].settings.is_ending = is_ending;
        hands_[i].reading = readings[i];
    }
    step_servos(hands_, now_s);
    for (std::size_t i = 0; i < hands_.size(); ++i)
        ticks_[i] = {hands_[i].tick, now_s, inputs_[i].order.number, is_ending, is_fresh_};
    is_fresh_ = false;
}

void ServoBank::begin_anew() noexcept {
    for (ServoHand& hand : hands_) {
        ServoState fresh;
        fresh.travel_m = hand.state.travel_m;
        fresh.turn = hand.state.turn;
        fresh.hand_energy_J = hand.state.hand_energy_J;
        fresh.poses = hand.state.poses;
        hand.state = fresh;
    }
    is_fresh_ = true;
}

}  // namespace palpa
