#include "haptics/hand.h"

#include <algorithm>
#include <cstddef>

namespace palpa {

std::optional<HandModel> hand_model(Grip grip) noexcept {
    switch (grip) {
        case Grip::None:
            return std::nullopt;
        case Grip::Light:
            return HandModel{0.10, 1, 50, 0, 0};
        case Grip::Slack:
            return HandModel{0.50, 1, 50, 0, 0};
        case Grip::Medium:
            return HandModel{0.15, 4, 200, 0, 0};
        case Grip::Firm:
            return HandModel{0.30, 10, 500, 0, 0};
        case Grip::FirmGrip:
            return HandModel{0.30, 10, 500, 1000, 5};
    }
    return std::nullopt;
}

std::optional<HandModel> relaxed(std::optional<HandModel> hand) noexcept {
    if (hand) hand->stiffness_N_per_m = 0;
    return hand;
}

double static_stiffness(const HandModel& hand) noexcept {
    if (hand.grip_stiffness_N_per_m <= 0) return hand.stiffness_N_per_m;
    return hand.stiffness_N_per_m * hand.grip_stiffness_N_per_m /
           (hand.stiffness_N_per_m + hand.grip_stiffness_N_per_m);
}

double minimum_jerk(double s) noexcept {
    s = std::clamp(s, 0.0, 1.0);
    return s * s * s * (10 - 15 * s + 6 * s * s);
}

double find_target(const std::vector<HandWaypoint>& path, double time_s) noexcept {
    const auto next = std::find_if(path.begin(), path.end(), [time_s](const HandWaypoint& point) {
        return time_s < point.time_s;
    });
    if (next == path.begin()) return path.empty() ? 0 : path.front().x_m;
    if (next == path.end()) return path.back().x_m;
    const HandWaypoint& from = *(next - 1);
    const double s = (time_s - from.time_s) / (next->time_s - from.time_s);
    return from.x_m + (next->x_m - from.x_m) * minimum_jerk(s);
}

}  // namespace palpa
