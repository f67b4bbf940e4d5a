// Measures the accuracy of the force on the hand over a scene's stroke, for force ranges and
// tolerances, against references that are independent of these settings and of the run's own error
// estimates.
#pragma once
#include "session/statistics.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

struct AccuracyOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file
    // The weakest and the strongest force that must be felt.
    std::vector<std::array<double, 2>> ranges_pN{{20, 3000}, {50, 10000}, {200, 5000}};
    std::vector<double> tolerances_pN{50, 150, 500};
    std::size_t samples = 20;  // compared ticks per stroke
};

struct AccuracyResult {
    std::array<double, 2> range_pN{};
    double within_pN = 0;
    Summary summary;
    double largest_hand_N = 0;  // largest force sent to the hand
    // For each sample: rendered force minus reference, pN.
    std::vector<double> errors_pN;
    double ninety_pN = 0, within_share = 0;
    double moving_pN = 0;  // median change of a reference over its last quarter, pN

    // Requirements that were not met although the run did not report it, as text.
    std::vector<std::string> unsaid() const;
};

// Reads the scene with all settings, before anything is played. Throws LoadError.
void check_accuracy(const AccuracyOptions& options);

// Plays the stroke with one range and one tolerance. Throws LoadError.
AccuracyResult play_accuracy(const AccuracyOptions& options, const std::array<double, 2>& range_pN,
                             double within_pN);

}  // namespace palpa
