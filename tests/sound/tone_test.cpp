#include "sound/tone.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

using namespace palpa;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr std::size_t second = sound_rate_hz;

std::vector<float> render(const Tone& tone, ToneState& state, std::size_t count) {
    std::vector<float> samples(count);
    render_tone(tone, state, samples);
    return samples;
}

// Places in samples where the wave goes up through zero, straight lines between samples.
std::vector<double> find_rises(std::span<const float> wave) {
    std::vector<double> rises;
    for (std::size_t i = 1; i < wave.size(); ++i) {
        const double before = wave[i - 1], after = wave[i];
        if (before < 0 && after >= 0)
            rises.push_back(static_cast<double>(i) - after / (after - before));
    }
    return rises;
}

double hertz_of(std::span<const float> wave) {
    const std::vector<double> rises = find_rises(wave);
    REQUIRE(rises.size() > 2);
    return sound_rate_hz * static_cast<double>(rises.size() - 1) / (rises.back() - rises.front());
}

double peak_of(std::span<const float> wave) {
    double peak = 0;
    for (const float sample : wave) peak = std::max(peak, std::abs(static_cast<double>(sample)));
    return peak;
}

double largest_step(std::span<const float> wave) {
    double largest = 0;
    for (std::size_t i = 1; i < wave.size(); ++i)
        largest = std::max(largest, std::abs(static_cast<double>(wave[i]) - wave[i - 1]));
    return largest;
}

// No wave that is never above `amplitude` nor higher than `hertz`, and glides by hundredths of a
// second, has larger steps.
double step_limit(double amplitude, double hertz) {
    return amplitude * (2 * std::numbers::pi * hertz / sound_rate_hz + 1 / (0.01 * sound_rate_hz));
}

}  // namespace

TEST_CASE("the stronger the force the higher the tone, two octaves over 3 N", "[sound]") {
    // Half of 3 N is an octave, a quarter half of one; above the cap nothing more.
    CHECK_THAT(tone_of(0.75).hertz, WithinRel(220 * std::sqrt(2.0), 1e-12));
    CHECK_THAT(tone_of(1.5).hertz, WithinRel(440, 1e-12));
    CHECK_THAT(tone_of(2.25).hertz, WithinRel(440 * std::sqrt(2.0), 1e-12));
    CHECK_THAT(tone_of(3).hertz, WithinRel(880, 1e-12));
    CHECK(tone_of(50).hertz == tone_of(3).hertz);
    // 0.125 N are a semitone, wherever they are.
    for (double force = 0.125; force <= 3; force += 0.125) {
        INFO(force << " N");
        CHECK_THAT(tone_of(force).hertz / tone_of(force - 0.0625).hertz,
                   WithinRel(std::pow(2.0, 1 / 24.0), 1e-12));
    }
}

TEST_CASE("the stronger the force the louder the tone, up to a limit", "[sound]") {
    // 0.02 N and a share of the 2.98 N above: power goes with the share.
    CHECK_THAT(tone_of(0.02 + 2.98 / 100).amplitude, WithinRel(0.025, 1e-9));
    CHECK_THAT(tone_of(0.02 + 2.98 / 4).amplitude, WithinRel(0.125, 1e-9));
    CHECK_THAT(tone_of(3).amplitude, WithinRel(0.25, 1e-12));
    CHECK(tone_of(1e9).amplitude == tone_of(3).amplitude);
}

TEST_CASE("what is too weak, and what is no force, is silent", "[sound]") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double force :
         {0.0, 0.02, -1.0, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
        INFO(force << " N");
        CHECK(tone_of(force).amplitude == 0);
        CHECK(std::isfinite(tone_of(force).hertz));
    }
    CHECK(tone_of(0.021).amplitude > 0);
    CHECK(tone_of(0.021).amplitude < 0.01);
}

TEST_CASE("the wave has the tone's frequency and amplitude", "[sound]") {
    const Tone tone{GENERATE(220.0, 311.1, 440.0, 880.0), GENERATE(0.02, 0.25)};
    ToneState state;

    const std::vector<float> wave = render(tone, state, 2 * second);

    const auto settled = std::span(wave).subspan(second);
    // A float has 24 bits, and a sine is straight near zero: 1 in 100 000 of a sample.
    CHECK_THAT(hertz_of(settled), WithinRel(tone.hertz, 1e-6));
    // The highest sample is at most half a sample from the crest: cos(pi f / rate).
    CHECK(peak_of(settled) > tone.amplitude * std::cos(std::numbers::pi * 880 / sound_rate_hz));
    CHECK(peak_of(wave) <= static_cast<float>(tone.amplitude));
}

TEST_CASE("a tone begins at its own pitch, out of silence", "[sound]") {
    ToneState state;
    (void)render({880, 0.25}, state, second);
    (void)render({}, state, second);

    const std::vector<float> wave = render({220, 0.25}, state, second / 20);

    CHECK(wave[0] == 0);
    CHECK_THAT(hertz_of(wave),
               WithinRel(220, 0.005));  // which grows: crossings stay where they are
}

TEST_CASE("whatever the force does, nothing clicks and nothing is too loud", "[sound]") {
    ToneState state;
    std::vector<float> wave;
    // Frames of a picture, 16 to 17 ms, with forces that leap over the whole range and stop.
    std::uint64_t number = 1;
    for (int frame = 0; frame < 1000; ++frame) {
        number = number * 6364136223846793005U + 1442695040888963407U;
        const double force = static_cast<double>(number >> 40) / (1 << 24) * 5 - 1;
        const std::vector<float> more = render(tone_of(force), state, 800 + frame % 17);
        wave.insert(wave.end(), more.begin(), more.end());
    }

    CHECK(peak_of(wave) <= 0.25);
    CHECK(peak_of(wave) > 0.2);
    CHECK(largest_step(wave) <= step_limit(0.25, 880));
}

TEST_CASE("a tone that stops keeps its pitch and ends in zeros", "[sound]") {
    ToneState state;
    (void)render({440, 0.25}, state, second);

    const std::vector<float> fading = render({}, state, second / 8);
    const std::vector<float> after = render({}, state, second);

    // After 0.01 s ln(0.25/1e-5) = 0.1013 s it is below what 16 bits can tell.
    const auto first = std::span(fading);
    CHECK(peak_of(first.subspan(second / 10)) > 0);
    CHECK(peak_of(first.subspan(second * 102 / 1000)) == 0);
    CHECK(peak_of(after) == 0);
    CHECK_THAT(hertz_of(first.first(second / 20)), WithinRel(440, 0.005));
    CHECK(largest_step(fading) <= step_limit(0.25, 440));
}

TEST_CASE("the wave does not know in how many pieces it is asked for", "[sound]") {
    const auto piece = GENERATE(std::size_t{1}, std::size_t{7}, std::size_t{512});
    const std::vector<Tone> tones{{220, 0.1}, {880, 0.25}, {}, {440, 0.2}};
    ToneState whole_state, state;
    for (const Tone& tone : tones) {
        const std::vector<float> whole = render(tone, whole_state, second / 7);
        std::vector<float> pieces(whole.size());
        for (std::size_t at = 0; at < pieces.size(); at += piece) {
            const std::size_t count = std::min(piece, pieces.size() - at);
            render_tone(tone, state, std::span(pieces).subspan(at, count));
        }

        CHECK(pieces == whole);
    }
}

TEST_CASE("a click is heard once, whatever the blocks, and is gone after 30 ms", "[sound]") {
    const auto play = [](std::size_t block) {
        ToneState state;
        std::vector<float> all(6000);
        for (std::size_t at = 0; at < all.size(); at += block) {
            Tone tone;
            tone.clicks = at >= 1200 ? 1 : 0;
            render_tone(tone, state, std::span(all).subspan(at, std::min(block, all.size() - at)));
        }
        return all;
    };
    const std::vector<float> samples = play(400);
    CHECK(samples == play(1200));
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double t = (static_cast<double>(i) - 1200) / 48'000;
        const bool is_heard = t >= 0 && t < 0.030;
        const double expected =
            is_heard ? 0.35 * std::exp(-t / 0.003) * std::sin(2 * 3.14159265358979 * 1800 * t) : 0;
        REQUIRE(samples[i] == Approx(expected).margin(1e-6));
    }
}
