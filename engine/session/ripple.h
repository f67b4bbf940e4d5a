// Measures how much a signal oscillates: its rms above 3 Hz and its strongest frequency.
#pragma once
#include <optional>
#include <span>

namespace palpa {

struct Ripple {
    double rms = 0;    // in the signal's unit
    double hertz = 0;  // of the strongest spectral line; 0 without oscillation
};

// Subtracts the moving mean over 1/3 s, applied twice with both ends padded, and leaves out a tenth
// of the signal at each end. This high-pass filter passes one third at 1 Hz, four fifths at 2 Hz
// and everything from 3 Hz on. Returns nothing for less than 1/3 s of samples.
std::optional<Ripple> measure_ripple(std::span<const double> samples, double tick_s);

}  // namespace palpa
