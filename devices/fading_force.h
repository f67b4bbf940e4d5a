// The force that a servo asks of a device whose own thread plays it.
#pragma once
#include "core/mailbox.h"
#include "math/vec.h"

#include <algorithm>

namespace palpa {

class FadingForce {
public:
    // Of a force that no newer one follows, because the servo died: after how many ticks it
    // begins to fade, and in how many it is gone.
    static constexpr int stale_ticks = 20, fade_ticks = 50;

    // By the servo, N.
    void post(const Vec3& newton) noexcept { posted_.post(newton); }

    // By the device's thread, once a tick: the newest one, never more than the motors give; zero
    // where it is not finite.
    Vec3 take(double most_newton) noexcept {
        age_ticks_ = posted_.read(newest_) ? 0 : age_ticks_ + 1;
        if (!newest_.allFinite()) return Vec3::Zero();
        const double faded = static_cast<double>(age_ticks_ - stale_ticks) / fade_ticks;
        const double share = std::clamp(1 - faded, 0.0, 1.0);
        const double norm = newest_.stableNorm();
        return newest_ * (norm > most_newton ? share * most_newton / norm : share);
    }

private:
    Mailbox<Vec3> posted_;
    Vec3 newest_ = Vec3::Zero();
    int age_ticks_ = 0;
};

}  // namespace palpa
