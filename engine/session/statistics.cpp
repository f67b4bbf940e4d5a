#include "session/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace palpa {
namespace {

constexpr double ripple_window_s = 4;

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

}  // namespace

Statistics::Statistics(double tick_s, std::uint64_t ticks) : tick_s_(tick_s) {
    force_.reserve(ticks);
}

void Statistics::add(const ServoTick& tick) {
    const double distance = tick.touch.molecule_angstrom.x();
    if (running_.ticks == 0) running_.closest_angstrom = distance;
    ++running_.ticks;
    running_.closest_angstrom = std::min(running_.closest_angstrom, distance);
    running_.last_angstrom = distance;
    running_.net_work_J = tick.hand_energy_J;
    running_.largest_attraction_N = std::max(running_.largest_attraction_N, -tick.sent_newton.x());
    running_.largest_repulsion_N = std::max(running_.largest_repulsion_N, tick.sent_newton.x());
    running_.stopped = tick.stopped;
    if (tick.clamped) ++clamped_ticks_;
    force_.push_back(tick.sent_newton.x());
}

void Statistics::add_step(double seconds, bool finite) {
    ++running_.steps;
    if (!finite) ++running_.steps_not_finite;
    step_us_.push_back(seconds * 1e6);
}

Summary Statistics::summary() const {
    Summary summary = running_;
    summary.step_median_us = quantile(step_us_, 0.5);
    summary.step_p99_us = quantile(step_us_, 0.99);
    const auto window =
        std::min(force_.size(), static_cast<std::size_t>(std::lround(ripple_window_s / tick_s_)));
    summary.ripple = find_ripple(std::span(force_).last(window), tick_s_);
    if (summary.ticks > 0) {
        summary.clamped_share =
            static_cast<double>(clamped_ticks_) / static_cast<double>(summary.ticks);
    }
    return summary;
}

}  // namespace palpa
