#include "haptics/hand.h"

#include <algorithm>
#include <cstddef>

namespace palpa {
namespace {

HandTarget target_at(const HandWaypoint& point) noexcept {
    return {{point.x_m, point.y_m, point.z_m}, turn_of(point.turn_rad)};
}

}  // namespace

std::optional<HandModel> hand_model(HandGrip grip) noexcept {
    switch (grip) {
        case HandGrip::None:
            return std::nullopt;
        case HandGrip::Light:
            return HandModel{0.10, 1, 50, 0, 0};
        case HandGrip::Slack:
            return HandModel{0.50, 1, 50, 0, 0};
        case HandGrip::Medium:
            return HandModel{0.15, 4, 200, 0, 0};
        case HandGrip::Firm:
            return HandModel{0.30, 10, 500, 0, 0};
        case HandGrip::FirmGrip:
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

HandTarget find_target(const std::vector<HandWaypoint>& path, double time_s) noexcept {
    const auto next = std::find_if(path.begin(), path.end(), [time_s](const HandWaypoint& point) {
        return time_s < point.time_s;
    });
    if (path.empty()) return {};
    if (next == path.begin()) return target_at(path.front());
    if (next == path.end()) return target_at(path.back());
    const HandTarget from = target_at(*(next - 1)), to = target_at(*next);
    const double from_s = (next - 1)->time_s;
    const double share = minimum_jerk((time_s - from_s) / (next->time_s - from_s));
    return {from.place_m + share * (to.place_m - from.place_m),
            turn_between(from.orientation, to.orientation, share)};
}

}  // namespace palpa
