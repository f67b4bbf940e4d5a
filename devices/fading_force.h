// Passes forces from the servo to a device whose own thread sends them, and fades the force if the
// servo stops.
#pragma once
#include "core/mailbox.h"
#include "math/vec.h"

#include <algorithm>

namespace palpa {

class FadingForce {
public:
    // If no newer force arrives because the servo has stopped: number of ticks until the force
    // begins to fade, and number of ticks of the fade.
    static constexpr int stale_ticks = 20, fade_ticks = 50;

    // Called by the servo, N.
    void post(const Vec3& newton) noexcept { posted_.post(newton); }

    // Called by the device's thread once a tick: the newest force, limited to `most_newton`; zero
    // if it is not finite.
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
