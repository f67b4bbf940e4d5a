#include "session/feel.h"

#include "haptics/gains.h"
#include "haptics/guarded.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>

namespace palpa {

Yielding find_yielding(const Feel& feel) {
    constexpr double most = 0.9, noticeable = 1.01;
    Yielding yielding;
    if (const auto within_pN = feel.within_pN; within_pN && feel.within_share < most) {
        yielding.tolerance = fmt::format(
            "the tolerance: nine tenths of the time within {:.3g} pN, {:.3g} times the {:.6g} "
            "asked",
            feel.ninety_pN, feel.ninety_pN / *within_pN, *within_pN);
    }
    if (feel.within_pN && feel.period_share > 1) {
        yielding.period =
            fmt::format("the period: a step takes {:.3g} times as long", feel.period_share);
    }
    if (feel.largest_raise > noticeable) {
        yielding.reach =
            fmt::format("the reach: A_d was raised up to {:.3g} times", feel.largest_raise);
    }
    if (feel.warm_share > 0) {
        yielding.motors =
            fmt::format("the motors: for {:.3g} % of the time they were too warm for the force",
                        100 * feel.warm_share);
    }
    return yielding;
}

std::vector<std::string> Yielding::all() const {
    std::vector<std::string> all;
    for (const std::string& text : {tolerance, period, reach, motors}) {
        if (!text.empty()) all.push_back(text);
    }
    return all;
}

FeelLog::FeelLog(const SceneDescription& scene, const ServoSettings& servo)
    : is_asked_(scene.coupling.feel_pN || scene.coupling.feel_within_pN),
      period_us_(1e3 * scene.period_ms) {
    feel_.within_pN = scene.coupling.feel_within_pN;
    if (!servo.guarded) return;
    cap_N_per_m_ = guarded_cap(scene.device.viscosity_N_s_per_m, servo.guarded->damping_N_s_per_m,
                               servo.delay_ticks);
    feel_.range_pN = scene.coupling.feel_pN;
    if (const auto range = feel_.range_pN) {
        for (std::size_t i = 0; i < range->size(); ++i)
            feel_.ends_newton[i] = hand_force(servo.guarded->force_law, (*range)[i] * 1e-12);
    }
}

void FeelLog::add(const ServoTick& tick) noexcept {
    if (cap_N_per_m_ <= 0) return;
    told_newton_ = tick.touch.force_newton;
    feel_.stiffest_share = std::max(feel_.stiffest_share, tick.felt_N_per_m / cap_N_per_m_);
    feel_.largest_raise = std::max(feel_.largest_raise, tick.raised);
    ++ticks_;
    if (tick.stage == SafetyStage::Hot || tick.stage == SafetyStage::Warm) ++warm_ticks_;
}

void FeelLog::add_step(const SettleReport& settled) {
    ++steps_;
    feel_.active += static_cast<double>(settled.active);
    feel_.steps += static_cast<double>(settled.steps);
    if (const auto error_pN = settled.audited_pN) add_error(*error_pN);
}

void FeelLog::add_answer(const TouchModel& answer) {
    constexpr std::uint64_t every = 100;
    if (cap_N_per_m_ <= 0 || ++steps_ % every != 0) return;
    add_error(1e12 * (answer.force_newton - told_newton_).norm());
}

void FeelLog::add_error(double error_pN) {
    found_.push_back({error_pN, steps_ - last_audit_});
    last_audit_ = steps_;
}

std::optional<Feel> FeelLog::feel(double step_median_us) const {
    if (!is_asked_) return std::nullopt;
    Feel feel = feel_;
    feel.period_share = step_median_us / period_us_;
    if (ticks_ > 0)
        feel.warm_share = static_cast<double>(warm_ticks_) / static_cast<double>(ticks_);
    if (steps_ > 0) {
        feel.active /= static_cast<double>(steps_);
        feel.steps /= static_cast<double>(steps_);
    }
    feel.audits = found_.size();
    if (found_.empty()) return feel;
    std::vector<Found> sorted = found_;
    std::ranges::sort(sorted, {}, &Found::error_pN);
    // What it is at most for that share of the time.
    const auto quantile = [&](double share) {
        double left = share * static_cast<double>(last_audit_) - 1e-6;
        for (const auto& [error_pN, steps] : sorted) {
            left -= static_cast<double>(steps);
            if (left <= 0) return error_pN;
        }
        return sorted.back().error_pN;
    };
    feel.median_pN = quantile(0.5);
    feel.ninety_pN = quantile(0.9);
    const double within_pN = feel.within_pN.value_or(0);
    double within = 0;
    for (const auto& [error_pN, steps] : sorted)
        if (error_pN <= within_pN) within += static_cast<double>(steps);
    feel.within_share = within / static_cast<double>(last_audit_);
    return feel;
}

}  // namespace palpa
