#include "session/accuracy_report.h"

#include "haptics/gains.h"
#include "haptics/guarded.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>

namespace palpa {

UnmetRequirements find_unmet(const AccuracyReport& report) {
    constexpr double most = 0.9, noticeable = 1.01;
    UnmetRequirements unmet;
    if (report.within_pN && report.estimates == 0) {
        unmet.tolerance = "tolerance: no error was estimated: the run is too short, or not guarded";
    } else if (const auto within_pN = report.within_pN; within_pN && report.within_share < most) {
        unmet.tolerance = fmt::format(
            "tolerance: for 90 % of the time the error was below {:.3g} pN, {:.3g} times the limit "
            "of {:.6g} pN",
            report.ninety_pN, report.ninety_pN / *within_pN, *within_pN);
    }
    if (report.within_pN && report.period_share > 1) {
        unmet.period = fmt::format("period: a step takes {:.3g} times the declared period",
                                   report.period_share);
    }
    if (report.largest_cap_ratio > noticeable) {
        unmet.reach = fmt::format("reach: A_d was raised up to {:.3g} times (cap ratio)",
                                  report.largest_cap_ratio);
    }
    if (report.thermal_share > 0) {
        unmet.motors = fmt::format("motors: at their thermal limit for {:.3g} % of the time",
                                   100 * report.thermal_share);
    }
    return unmet;
}

std::vector<std::string> UnmetRequirements::all() const {
    std::vector<std::string> all;
    for (const std::string& text : {tolerance, period, reach, motors}) {
        if (!text.empty()) all.push_back(text);
    }
    return all;
}

AccuracyLog::AccuracyLog(const SceneDescription& scene, std::size_t hand,
                         const ServoSettings& servo)
    : period_us_(1e3 * scene.period_ms) {
    const CouplingDescription& coupling = coupling_of(scene, hand);
    is_asked_ = coupling.feel_pN || coupling.feel_within_pN;
    report_.within_pN = coupling.feel_within_pN;
    if (!servo.guarded) return;
    cap_N_per_m_ = servo.guarded->device_cap_N_per_m;
    report_.range_pN = coupling.feel_pN;
    if (const auto range = report_.range_pN) {
        for (std::size_t i = 0; i < range->size(); ++i)
            report_.ends_newton[i] = hand_force(servo.guarded->force_law, (*range)[i] * 1e-12);
    }
}

void AccuracyLog::add(const ServoTick& tick) noexcept {
    if (cap_N_per_m_ <= 0) return;
    rendered_newton_ = tick.contact.force_newton;
    report_.stiffest_share = std::max(report_.stiffest_share, tick.felt_N_per_m / cap_N_per_m_);
    report_.largest_cap_ratio = std::max(report_.largest_cap_ratio, tick.cap_ratio);
    ++ticks_;
    if (tick.stage == SafetyStage::ThermalLimit || tick.stage == SafetyStage::CoolDown)
        ++thermal_ticks_;
}

void AccuracyLog::add_step(const RelaxStepReport& relaxed, std::optional<double> error_pN) {
    ++steps_;
    report_.active += static_cast<double>(relaxed.active);
    report_.steps += static_cast<double>(relaxed.steps);
    if (relaxed.estimated_error_pN && error_pN) add_error(*error_pN);
}

void AccuracyLog::add_model(const ContactModel& model) {
    constexpr std::uint64_t every = 100;
    if (cap_N_per_m_ <= 0 || ++steps_ % every != 0) return;
    add_error(1e12 * (model.force_newton - rendered_newton_).norm());
}

void AccuracyLog::add_error(double error_pN) {
    if (!is_asked_) return;
    found_.push_back({error_pN, steps_ - last_estimate_});
    last_estimate_ = steps_;
    ++estimates_;
    if (found_.size() == most_found) merge_neighbours();
}

void AccuracyLog::merge_neighbours() {
    std::ranges::sort(found_, {}, &Found::error_pN);
    for (std::size_t i = 0; i < found_.size() / 2; ++i) {
        const Found& smaller = found_[2 * i];
        const Found& larger = found_[2 * i + 1];
        found_[i] = {larger.error_pN, smaller.steps + larger.steps};
    }
    found_.resize(found_.size() / 2);
}

std::optional<AccuracyReport> AccuracyLog::report(double step_median_us) const {
    if (!is_asked_) return std::nullopt;
    AccuracyReport report = report_;
    report.period_share = step_median_us / period_us_;
    if (ticks_ > 0)
        report.thermal_share = static_cast<double>(thermal_ticks_) / static_cast<double>(ticks_);
    if (steps_ > 0) {
        report.active /= static_cast<double>(steps_);
        report.steps /= static_cast<double>(steps_);
    }
    report.estimates = estimates_;
    if (found_.empty()) return report;
    std::vector<Found> sorted = found_;
    std::ranges::sort(sorted, {}, &Found::error_pN);
    // What it is at most for that share of the time.
    const auto quantile = [&](double share) {
        double left = share * static_cast<double>(last_estimate_) - 1e-6;
        for (const auto& [error_pN, steps] : sorted) {
            left -= static_cast<double>(steps);
            if (left <= 0) return error_pN;
        }
        return sorted.back().error_pN;
    };
    report.median_pN = quantile(0.5);
    report.ninety_pN = quantile(0.9);
    const double within_pN = report.within_pN.value_or(0);
    double within = 0;
    for (const auto& [error_pN, steps] : sorted)
        if (error_pN <= within_pN) within += static_cast<double>(steps);
    report.within_share = within / static_cast<double>(last_estimate_);
    return report;
}

}  // namespace palpa
