// Converts a felt force to a tone (pitch, loudness and samples), for people whose device does not
// render it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpa {

// The range of forces that can be heard. The lower one lies above the ripple of guarded coupling on
// a hand at rest, so that nothing is heard without contact. The upper one is the usual force cap
// (`coupling.clamp_N`); larger forces sound the same.
inline constexpr double faintest_heard_newton = 0.02, strongest_heard_newton = 3;

// From A3 to A5, two octaves: neither shrill nor too low for small loudspeakers.
inline constexpr double lowest_hertz = 220, highest_hertz = 880;

// Largest amplitude relative to full scale, low enough not to startle at a high volume setting.
inline constexpr double loudest_amplitude = 0.25;

inline constexpr int sound_rate_hz = 48'000;  // samples per second

struct Tone {
    double hertz = lowest_hertz;
    double amplitude = 0;      // 0 to 1; 0 is silence
    std::uint64_t clicks = 0;  // so far: one is heard whenever the number grows
};

// A click is a damped sine that is gone after 30 ms.
inline constexpr double click_hertz = 1800, click_decay_s = 0.003, click_amplitude = 0.35;

// The tone for a norm of the force. log f is proportional to the force, 8 semitones per newton, so
// that equal steps of force sound like equal steps of pitch. The power of the wave (amplitude
// squared) is proportional to the force above the lower limit, and loudness to its 0.3rd power (S.
// S. Stevens, Psychol. Rev. 64, 1957). Silence below the lower limit and for a force that is not
// finite.
Tone tone_of(double force_newton) noexcept;

// State of the oscillator.
struct ToneState {
    double turns = 0;  // phase of the oscillator, turns, 0 to 1
    double hertz = lowest_hertz;
    double amplitude = 0;
    std::uint64_t clicks = 0;    // that were begun
    std::size_t click_left = 0;  // samples of the last one that are still to come
};

// Writes the next samples, -1 to 1, at `sound_rate_hz`. Pitch and loudness approach the wanted tone
// with a time constant of 10 ms, which hides the 16 ms steps of pictures and avoids clicks. A
// fading tone keeps its pitch and ends in zeros; a new one starts at its own pitch. The result does
// not depend on the number of samples per call. Clicks are added to the tone.
void render_tone(const Tone& wanted, ToneState& state, std::span<float> samples) noexcept;

}  // namespace palpa
