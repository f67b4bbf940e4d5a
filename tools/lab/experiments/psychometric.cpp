#include "tools/lab/experiments/psychometric.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace palpa {
namespace {

constexpr double three_of_four = 0.6744897501960817;  // Φ of this is 0.75

// A curve steeper than this share of the smallest step between levels, or wider than this many
// times all of them, is as good as a limit.
constexpr double narrowest = 1.0 / 6, widest = 10;

double normal_share(double z) noexcept { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_density(double z) noexcept {
    return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
}

// d(share)/d(middle), d(share)/d(log width).
Eigen::Vector2d share_gradient(const PsychometricCurve& curve, double level) noexcept {
    const double z = (level - curve.middle) / curve.width;
    const double density = (1 - lapse_share) * normal_density(z);
    return {-density / curve.width, -density * z};
}

// Expected from so many answers at these levels.
Eigen::Matrix2d information(const PsychometricCurve& curve,
                            std::span<const AnsweredLevel> levels) noexcept {
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (const AnsweredLevel& at : levels) {
        const double p = curve.share(at.level);
        const Eigen::Vector2d slope = share_gradient(curve, at.level);
        sum += static_cast<double>(at.answers) / (p * (1 - p)) * slope * slope.transpose();
    }
    return sum;
}

// Where curves are looked for.
struct Range {
    double first = 0, last = 0;      // of the middle: as far outside of the levels as they reach
    double narrow = 0, wide = 0;     // of the width
    double lowest = 0, highest = 0;  // level
};

Range find_range(std::span<const AnsweredLevel> levels) {
    std::vector<double> places;
    for (const AnsweredLevel& at : levels)
        if (at.answers > 0) places.push_back(at.level);
    std::ranges::sort(places);
    const auto last = std::ranges::unique(places).begin();
    places.erase(last, places.end());
    if (places.size() < 2) return {};
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < places.size(); ++i)
        step = std::min(step, places[i] - places[i - 1]);
    const double all = places.back() - places.front();
    return {places.front() - all, places.back() + all, narrowest * step,
            widest * all,         places.front(),      places.back()};
}

PsychometricCurve clamped(const PsychometricCurve& curve, const Range& range) {
    return {std::clamp(curve.middle, range.first, range.last),
            std::clamp(curve.width, range.narrow, range.wide)};
}

// The best of a grid: the likelihood may have more than one summit.
PsychometricCurve find_start(std::span<const AnsweredLevel> levels, const Range& range) {
    constexpr int steps = 60;
    PsychometricCurve best;
    double highest = -std::numeric_limits<double>::infinity();
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            const PsychometricCurve curve{
                range.first + (range.last - range.first) * i / steps,
                range.narrow * std::pow(range.wide / range.narrow, static_cast<double>(j) / steps)};
            const double value = find_log_likelihood(curve, levels).value;
            if (value <= highest) continue;
            highest = value;
            best = curve;
        }
    }
    return best;
}

}  // namespace

double PsychometricCurve::share(double level) const noexcept {
    return 0.5 * lapse_share + (1 - lapse_share) * normal_share((level - middle) / width);
}

double PsychometricCurve::threshold() const noexcept { return three_of_four * width; }

double PsychometricCurve::slope() const noexcept { return normal_density(0) / width; }

LogLikelihood find_log_likelihood(const PsychometricCurve& curve,
                                  std::span<const AnsweredLevel> levels) noexcept {
    LogLikelihood sum;
    for (const AnsweredLevel& at : levels) {
        const double p = curve.share(at.level);
        const auto more = static_cast<double>(at.more);
        const double less = static_cast<double>(at.answers) - more;
        sum.value += more * std::log(p) + less * std::log(1 - p);
        const Eigen::Vector2d slope = (more / p - less / (1 - p)) * share_gradient(curve, at.level);
        sum.gradient[0] += slope(0);
        sum.gradient[1] += slope(1);
    }
    return sum;
}

PsychometricFit fit_psychometric(std::span<const AnsweredLevel> levels) {
    constexpr int most_steps = 200;
    PsychometricFit fit;
    const Range range = find_range(levels);
    if (range.wide <= 0) return fit;
    fit.curve = find_start(levels, range);
    // Fisher's scoring: Newton's way with the expected second derivatives, shortened until it
    // climbs.
    LogLikelihood here = find_log_likelihood(fit.curve, levels);
    for (int i = 0; i < most_steps; ++i) {
        const Eigen::Vector2d gradient(here.gradient[0], here.gradient[1]);
        const Eigen::Matrix2d weight =
            information(fit.curve, levels) + 1e-9 * Eigen::Matrix2d::Identity();
        Eigen::Vector2d step = weight.inverse() * gradient;
        bool climbs = false;
        for (int halving = 0; halving < 40 && !climbs; ++halving, step *= 0.5) {
            const PsychometricCurve next =
                clamped({fit.curve.middle + step(0), fit.curve.width * std::exp(step(1))}, range);
            const LogLikelihood there = find_log_likelihood(next, levels);
            climbs = there.value > here.value;
            if (!climbs) continue;
            fit.curve = next;
            here = there;
        }
        if (!climbs) break;
    }
    // What lies beyond all levels is not found, however steep the curve is there: the middle, or
    // both places where 3 of 4 answer alike.
    const double middle = fit.curve.middle, threshold = fit.curve.threshold();
    const bool has_middle = middle >= range.lowest && middle <= range.highest;
    const bool has_threshold =
        middle + threshold <= range.highest || middle - threshold >= range.lowest;
    if (!has_middle || !has_threshold) return fit;
    fit.end = PsychometricEnd::TooSteep;
    if (fit.curve.width > 1.01 * range.narrow) {
        const Eigen::Matrix2d covariance = information(fit.curve, levels).inverse();
        fit.end = PsychometricEnd::Found;
        fit.middle_error = std::sqrt(covariance(0, 0));
        fit.threshold_error = fit.curve.threshold() * std::sqrt(covariance(1, 1));
    }
    return fit;
}

}  // namespace palpa
