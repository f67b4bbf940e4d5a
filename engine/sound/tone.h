// A felt force as a tone, for a person whose device does not play it: how high, how loud, its wave.
#pragma once
#include <span>

namespace palpa {

// The ripple that guarded coupling may leave on a hand at rest stays below the first force, so that
// nothing is heard where nothing pushes. The second is the usual cap (`coupling.clamp_N`); what is
// above it sounds the same.
inline constexpr double faintest_heard_newton = 0.02, strongest_heard_newton = 3;

// From A3 to A5, two octaves: not shrill, and not too low for small loudspeakers.
inline constexpr double lowest_hertz = 220, highest_hertz = 880;

// Of full scale, 1: as loud as it ever is, so that a person who has the volume up is not startled.
inline constexpr double loudest_amplitude = 0.25;

inline constexpr int sound_rate_hz = 48'000;  // samples

struct Tone {
    double hertz = lowest_hertz;
    double amplitude = 0;  // 0 to 1; 0 is silence
};

// Of the norm of the force. Steps in pitch are to the ear what steps of the force are to the hand:
// log f rises in proportion to the force, 8 semitones a newton. The wave's power (amplitude
// squared) rises in proportion to the force above the faintest, and so its loudness with the power
// 0.3 of that (S. S. Stevens, Psychol. Rev. 64, 1957): a gentle rise. Below the faintest, and where
// the force is no finite number, silence.
Tone tone_of(double force_newton) noexcept;

// The wave at this moment.
struct ToneState {
    double turns = 0;  // of the oscillator, 0 to 1
    double hertz = lowest_hertz;
    double amplitude = 0;
};

// The next samples, from -1 to 1, at `sound_rate_hz`. Pitch and loudness glide to what is wanted
// with a time constant of 10 ms, which hides the steps of a picture's 16 ms and makes no click. A
// tone that fades keeps its pitch and ends in zeros; one that begins has its own from the start.
// How many samples are asked for at once changes nothing.
void render_tone(const Tone& wanted, ToneState& state, std::span<float> samples) noexcept;

}  // namespace palpa
