#include "session/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

constexpr double ripple_window_s = 4;

// Step times fall into classes 1 % wide, from a nanosecond up to three hours.
constexpr double shortest_us = 1e-3, class_width = 1.01;
constexpr std::size_t class_count = 3000;

std::size_t class_of(double time_us) {
    const double place = std::log(std::max(time_us, shortest_us) / shortest_us);
    return std::min(static_cast<std::size_t>(place / std::log(class_width)), class_count - 1);
}

// What held the force back beside slew, clamp, and a hand that takes hold for the first time.
SafetyStage trouble_of(const ServoTick& tick) {
    if (tick.stage == SafetyStage::ThermalLimit || tick.stage > SafetyStage::Disengaged)
        return tick.stage;
    return tick.reason;
}

}  // namespace

StepTimes::StepTimes() : counts_(class_count, 0) {}

void StepTimes::add(double seconds) {
    ++steps_;
    ++counts_[class_of(seconds * 1e6)];
}

double StepTimes::quantile_us(double share) const {
    if (steps_ == 0) return 0;
    const double wanted = share * static_cast<double>(steps_);
    double seen = 0;
    std::size_t at = 0;
    for (; at + 1 < class_count; ++at) {
        seen += static_cast<double>(counts_[at]);
        if (seen >= wanted) break;
    }
    return shortest_us * std::pow(class_width, static_cast<double>(at) + 0.5);
}

Statistics::Statistics(double tick_s) : tick_s_(tick_s) {
    for (std::vector<double>& axis : recent_force_)
        axis.resize(static_cast<std::size_t>(std::lround(ripple_window_s / tick_s)), 0.0);
}

// A new grip begins the path anew: the molecule may be another one, and the jump is not a movement
// of the hand. A contact that is still may have no molecule.
void Statistics::add_place(const ContactModel& contact) {
    const Vec3& place = contact.molecule.place_angstrom;
    const double distance = place.norm();
    if (running_.ticks == 0) running_.closest_angstrom = distance;
    if (running_.ticks == 0 || contact.grip_number != grip_number_) first_place_angstrom_ = place;
    grip_number_ = contact.grip_number;
    // What began that near was on no side.
    constexpr double on_top = 1;  // Å
    const bool beyond =
        first_place_angstrom_.norm() > on_top && place.dot(first_place_angstrom_) < 0;
    running_.closest_angstrom = std::min(running_.closest_angstrom, distance);
    running_.went_through = running_.went_through || beyond;
    // Only on one axis is there a side.
    running_.last_angstrom = beyond && contact.active_freedom <= 1 ? -distance : distance;
}

// Counts the way in straight pieces of half a millimetre, so that encoder steps and tremor add
// nothing.
void Statistics::add_travel(const ServoTick& tick) {
    constexpr double piece_m = 0.5e-3;
    running_.travel.lost_m += tick.clipped_m.norm();
    if (tick.is_at_stop && !tick.clutched) ++stop_ticks_;
    if (!is_sane(tick.reading)) return;
    const Vec3& handle_m = tick.reading.position_m;
    // Nothing is in hand while the device is exchanged.
    if (tick.clutched || tick.contact.is_still || !counted_m_) {
        counted_m_ = handle_m;
        is_in_stroke_ = false;
        return;
    }
    const double length = (handle_m - *counted_m_).norm();
    if (length < piece_m) return;
    running_.travel.handle_m += length;
    counted_m_ = handle_m;
    if (!is_in_stroke_) ++running_.travel.strokes;
    is_in_stroke_ = true;
}

void Statistics::add(const ServoTick& tick) {
    if (running_.ticks == 0 || !tick.contact.is_still) add_place(tick.contact);
    running_.net_work_J = tick.hand_energy_J;
    running_.largest_felt_N = std::max(running_.largest_felt_N, tick.sent_newton.norm());
    running_.is_on_axis = tick.contact.active_freedom <= 1;
    if (running_.is_on_axis) {
        const double apart = tick.sent_newton.x();
        running_.largest_attraction_N = std::max(running_.largest_attraction_N, -apart);
        running_.largest_repulsion_N = std::max(running_.largest_repulsion_N, apart);
    }
    add_travel(tick);
    running_.stopped = tick.stopped;
    running_.is_safety_full = running_.is_safety_full && tick.is_safety_full;
    if (tick.clamped) ++clamped_ticks_;
    if (const SafetyStage trouble = trouble_of(tick); trouble != SafetyStage::None) {
        ++safety_ticks_;
        running_.gravest = std::max(running_.gravest, trouble);
    }
    for (std::size_t axis = 0; axis < recent_force_.size(); ++axis)
        recent_force_[axis][running_.ticks % recent_force_[axis].size()] =
            tick.sent_newton(static_cast<Eigen::Index>(axis));
    ++running_.ticks;
}

void Statistics::add_step(double seconds, bool finite) {
    ++running_.steps;
    if (!finite) ++running_.steps_not_finite;
    step_times_.add(seconds);
}

Summary Statistics::summary() const {
    Summary summary = running_;
    summary.step_median_us = step_times_.quantile_us(0.5);
    summary.step_p99_us = step_times_.quantile_us(0.99);
    for (std::vector<double> force : recent_force_) {
        const auto oldest = static_cast<std::ptrdiff_t>(running_.ticks % force.size());
        if (running_.ticks >= force.size()) {
            std::rotate(force.begin(), force.begin() + oldest, force.end());
        } else {
            force.resize(running_.ticks);
        }
        const std::optional<Ripple> ripple = measure_ripple(force, tick_s_);
        if (ripple && (!summary.ripple || ripple->rms > summary.ripple->rms))
            summary.ripple = ripple;
    }
    if (summary.ticks > 0) {
        summary.clamped_share =
            static_cast<double>(clamped_ticks_) / static_cast<double>(summary.ticks);
        summary.safety_share =
            static_cast<double>(safety_ticks_) / static_cast<double>(summary.ticks);
        summary.travel.at_stop_s = static_cast<double>(stop_ticks_) * tick_s_;
    }
    return summary;
}

}  // namespace palpa
