#include "session/ripple.h"

#include "core/repeatable.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace palpa {
namespace {

constexpr double cut_hz = 3, highest_hz = 100;

// Centred moving mean over an odd number of samples, the ends of the signal continued flat.
std::vector<double> moving_mean(const std::vector<double>& signal, std::size_t width) {
    const auto half = static_cast<std::ptrdiff_t>(width / 2);
    const auto last = static_cast<std::ptrdiff_t>(signal.size()) - 1;
    const auto at = [&](std::ptrdiff_t i) {
        return signal[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))];
    };
    double sum = 0;
    for (std::ptrdiff_t i = -half; i <= half; ++i) sum += at(i);
    std::vector<double> mean;
    mean.reserve(signal.size());
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
        mean.push_back(sum / static_cast<double>(width));
        sum += at(i + half + 1) - at(i - half);
    }
    return mean;
}

// Power of one frequency, in cycles per sample, under a Hann window (Goertzel's recurrence).
double power(std::span<const double> signal, double frequency) {
    const double turn = 2 * repeatable::cos(2 * std::numbers::pi * frequency);
    const double window = 2 * std::numbers::pi / static_cast<double>(signal.size());
    double older = 0, newer = 0;
    for (std::size_t i = 0; i < signal.size(); ++i) {
        const double hann = 1 - repeatable::cos(window * static_cast<double>(i));
        const double next = turn * newer - older + hann * signal[i];
        older = newer;
        newer = next;
    }
    return newer * newer + older * older - turn * newer * older;
}

}  // namespace

std::optional<Ripple> measure_ripple(std::span<const double> samples, double tick_s) {
    const auto width = static_cast<std::size_t>(std::lround(1 / cut_hz / tick_s)) | 1;
    if (samples.size() < width) return std::nullopt;
    const std::vector<double> signal(samples.begin(), samples.end());
    const std::vector<double> slow = moving_mean(moving_mean(signal, width), width);
    const std::size_t cut = signal.size() / 10;
    std::vector<double> fast;
    double squares = 0;
    for (std::size_t i = cut; i + cut < signal.size(); ++i) {
        fast.push_back(signal[i] - slow[i]);
        squares += fast.back() * fast.back();
    }
    const auto count = static_cast<double>(fast.size());
    Ripple ripple{std::sqrt(squares / count), 0};
    if (ripple.rms == 0) return ripple;

    double strongest = 0;
    for (double line = 1; line / (count * tick_s) < highest_hz; ++line) {
        const double p = power(fast, line / count);
        if (p > strongest) {
            strongest = p;
            ripple.hertz = line / (count * tick_s);
        }
    }
    return ripple;
}

}  // namespace palpa
