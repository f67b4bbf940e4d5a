// The servos of all hands of a live session as a function of ticks, without clock, thread or
// device.
#pragma once
#include "core/mailbox.h"
#include "haptics/servo.h"
#include "session/live_events.h"

#include <cstddef>
#include <span>
#include <vector>

namespace palpa {

class ServoBank {
public:
    // `hands`: at most `most_hands`.
    explicit ServoBank(std::size_t hands);

    // Where the simulation of this hand posts contact models and orders and reads poses.
    Exchange& exchange(std::size_t slot) noexcept { return hands_[slot].exchange; }
    Mailbox<ServoOrder>& orders(std::size_t slot) noexcept { return inputs_[slot].orders; }

    // Applies the newest orders. Each hand needs one before the first tick.
    void take_orders() noexcept;
    // True if all devices, and with them the servo, stand still.
    bool is_paused() const noexcept;

    // One tick of all hands from the readings of their devices. Never throws, locks, waits or
    // allocates.
    void tick(std::span<const DeviceReading> readings, double now_s, bool is_ending) noexcept;
    // Results of the last tick, by slot.
    std::span<const LiveTick> ticks() const noexcept { return ticks_; }

    // Restarts all servos. Travel and work of the handles that molecules have received are not
    // taken back.
    void begin_anew() noexcept;

private:
    struct Input {
        Mailbox<ServoOrder> orders;
        ServoOrder order;  // the order in force
    };

    std::vector<ServoHand> hands_;
    std::vector<Input> inputs_;
    std::vector<LiveTick> ticks_;
    bool is_fresh_ = true;
};

}  // namespace palpa
