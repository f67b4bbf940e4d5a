// The servos of all hands of a live session, tick by tick, without clock, thread or device.
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
    // `most_hands` at most.
    explicit ServoBank(std::size_t hands);

    // Where the simulation posts contact models and orders, and reads poses.
    Exchange& exchange(std::size_t slot) noexcept { return hands_[slot].exchange; }
    Mailbox<ServoOrder>& orders(std::size_t slot) noexcept { return inputs_[slot].orders; }

    // The newest orders hold from now on. Before the first tick there must have been one for each.
    void take_orders() noexcept;
    // All devices stand still, and so does the servo.
    bool is_paused() const noexcept;

    // One tick of all hands with what their devices read. Never throws, locks, waits or allocates.
    void tick(std::span<const DeviceReading> readings, double now_s, bool is_ending) noexcept;
    // What the last one did, by slot.
    std::span<const LiveTick> ticks() const noexcept { return ticks_; }

    // Servos that know nothing of before. What molecules were given of the handles' travel and work
    // stays theirs.
    void begin_anew() noexcept;

private:
    struct Input {
        Mailbox<ServoOrder> orders;
        ServoOrder order;  // in force
    };

    std::vector<ServoHand> hands_;
    std::vector<Input> inputs_;
    std::vector<LiveTick> ticks_;
    bool is_fresh_ = true;
};

}  // namespace palpa
