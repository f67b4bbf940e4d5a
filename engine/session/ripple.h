// How much a signal shakes: what remains of it above 3 Hz, and how fast.
#pragma once
#include <optional>
#include <span>

namespace palpa {

struct Ripple {
    double rms = 0;    // in the signal's unit
    double hertz = 0;  // of the strongest line; 0 where nothing shakes
};

// The signal minus its moving mean over 1/3 s, taken twice, both ends padded; a tenth of the signal
// is then left out at each end. Of 1 Hz a third is left, of 2 Hz four fifths, from 3 Hz on all.
// Nothing where there is less than 1/3 s of samples.
std::optional<Ripple> measure_ripple(std::span<const double> samples, double tick_s);

}  // namespace palpa
