// The clock of a device that runs on the servo's ticks; a window can stop it or restart it.
#pragma once
#include "haptics/device.h"
#include "haptics/hand.h"

#include <cstdint>

namespace palpa {

class OrderedTime {
public:
    // `orders`: null if nobody posts orders; then time never stops.
    explicit OrderedTime(HandOrders* orders) noexcept : orders_(orders) {}

    // Call once a tick: takes the newest order. Returns false while time stands still.
    bool step() noexcept {
        was_restarted_ = false;
        if (!orders_) return true;
        const HandOrder before = order_;
        orders_->read(order_);
        was_restarted_ = order_.restarts != before.restarts;
        if (order_.grants != before.grants) granted_ticks_ = order_.granted_ticks;
        if (!order_.frozen) return true;
        if (granted_ticks_ == 0) return false;
        --granted_ticks_;
        return true;
    }

    // Whether the order of the last step restarted the clock.
    bool was_restarted() const noexcept { return was_restarted_; }
    // Target of the handle: while the clutch is pressed the middle of the workspace.
    Vec3 target_m() const noexcept {
        return order_.is_clutched ? Vec3(Vec3::Zero()) : order_.target_m;
    }
    bool is_clutched() const noexcept { return order_.is_clutched; }
    // The button bits of the device, see Button.
    std::uint32_t buttons() const noexcept {
        return order_.is_clutched ? static_cast<std::uint32_t>(Button::Clutch) : 0;
    }

private:
    HandOrders* orders_;
    HandOrder order_;
    int granted_ticks_ = 0;  // ticks that may still pass while the clock is stopped (single steps)
    bool was_restarted_ = false;
};

}  // namespace palpa
