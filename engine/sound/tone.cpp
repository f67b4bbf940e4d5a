#include "sound/tone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa {
namespace {

constexpr double glide_s = 0.01;
// Less than one step of 16 bits: a fading tone ends here.
constexpr double inaudible_amplitude = 1e-5;

constexpr std::size_t click_samples = 10 * static_cast<std::size_t>(click_decay_s * sound_rate_hz);

double next_of_click(ToneState& state) noexcept {
    if (state.click_left == 0) return 0;
    const double t = static_cast<double>(click_samples - state.click_left--) / sound_rate_hz;
    return click_amplitude * std::exp(-t / click_decay_s) *
           std::sin(2 * std::numbers::pi * click_hertz * t);
}

}  // namespace

Tone tone_of(double force_newton) noexcept {
    if (!std::isfinite(force_newton) || force_newton <= faintest_heard_newton) return {};
    const double force = std::min(force_newton, strongest_heard_newton);
    const double share =
        (force - faintest_heard_newton) / (strongest_heard_newton - faintest_heard_newton);
    return {.hertz = lowest_hertz *
                     std::pow(highest_hertz / lowest_hertz, force / strongest_heard_newton),
            .amplitude = loudest_amplitude * std::sqrt(share)};
}

void render_tone(const Tone& wanted, ToneState& state, std::span<float> samples) noexcept {
    const double share = -std::expm1(-1 / (glide_s * sound_rate_hz));  // of a sample
    if (state.amplitude == 0) state.turns = 0, state.hertz = wanted.hertz;
    if (wanted.clicks > state.clicks) state.click_left = click_samples;
    state.clicks = wanted.clicks;
    const double hertz = wanted.amplitude > 0 ? wanted.hertz : state.hertz;
    for (float& sample : samples) {
        sample = static_cast<float>(state.amplitude * std::sin(2 * std::numbers::pi * state.turns) +
                                    next_of_click(state));
        state.turns += state.hertz / sound_rate_hz;
        state.turns -= std::floor(state.turns);
        state.hertz += share * (hertz - state.hertz);
        state.amplitude += share * (wanted.amplitude - state.amplitude);
        if (wanted.amplitude == 0 && state.amplitude < inaudible_amplitude) state.amplitude = 0;
    }
}

}  // namespace palpa
