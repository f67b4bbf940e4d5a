#include "session/ripple.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

using namespace palpa;

namespace {

std::vector<double> wave(double hertz, double amplitude, double offset, double slope) {
    std::vector<double> samples;
    for (int i = 0; i < 4000; ++i) {
        const double t = i * 1e-3;
        samples.push_back(offset + slope * t +
                          amplitude * std::sin(2 * std::numbers::pi * hertz * t));
    }
    return samples;
}

}  // namespace

TEST_CASE("a sine above 3 Hz is told by its effective value and frequency", "[session][ripple]") {
    const double hertz = GENERATE(5.0, 6.6, 12.5, 40.0);

    const Ripple ripple = measure_ripple(wave(hertz, 1, 0.5, 0.2), 1e-3).value();

    CHECK(ripple.rms == Approx(1 / std::sqrt(2)).epsilon(0.1));
    CHECK(ripple.hertz == Approx(hertz).margin(0.2));
}

TEST_CASE("a force that stands or drifts does not ripple", "[session][ripple]") {
    CHECK(measure_ripple(wave(0, 0, 2.5, 0), 1e-3)->rms < 1e-12);
    CHECK(measure_ripple(wave(0, 0, -1, 0.5), 1e-3)->rms < 1e-3);
    CHECK(measure_ripple(wave(0.3, 1, 0, 0), 1e-3)->rms < 0.05);
}

TEST_CASE("too short a signal has no ripple", "[session][ripple]") {
    CHECK_FALSE(measure_ripple(std::vector<double>(100, 1.0), 1e-3).has_value());
    CHECK_FALSE(measure_ripple({}, 1e-3).has_value());
}
