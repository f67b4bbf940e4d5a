// The time of a device that lives on the servo's ticks: it stands still where a window says so.
#pragma once
#include "haptics/hand.h"

namespace palpa {

class OrderedTime {
public:
    // `orders`: null where nobody posts any, and time always goes on.
    explicit OrderedTime(HandOrders* orders) noexcept : orders_(orders) {}

    // Once a tick: takes the newest order. False where time stands still.
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

    // By the order that the last step took.
    bool was_restarted() const noexcept { return was_restarted_; }
    const Vec3& target_m() const noexcept { return order_.target_m; }

private:
    HandOrders* orders_;
    HandOrder order_;
    int granted_ticks_ = 0;  // that may still go by while frozen
    bool was_restarted_ = false;
};

}  // namespace palpa
