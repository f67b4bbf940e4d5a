// How exactly a scene's stroke is felt, for ranges of forces that must be felt and for
// tolerances; against references that do not know what was asked nor the run's own error estimates.
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
    std::size_t samples = 20;  // of a stroke
};

struct AccuracyResult {
    std::array<double, 2> range_pN{};
    double within_pN = 0;
    Summary summary;
    double largest_hand_N = 0;  // sent
    // Of each sample: the force that the servo rendered less the reference's.
    std::vector<double> errors_pN;
    double ninety_pN = 0, within_share = 0;
    double moving_pN = 0;  // by which the last quarter of a reference still changed it, median

    // Requirements that were not met and that the run did not report, in words.
    std::vector<std::string> unsaid() const;
};

// Reads the scene with all that is asked, before anything is played. Throws LoadError.
void check_accuracy(const AccuracyOptions& options);

// The stroke, with one range and one tolerance. Throws LoadError.
AccuracyResult play_accuracy(const AccuracyOptions& options, const std::array<double, 2>& range_pN,
                             double within_pN);

}  // namespace palpa
