// palpa feel: how exactly a scene's stroke is felt, for ranges of forces that must be felt and for
// tolerances; against references that do not know what was asked nor the run's own audits.
#pragma once
#include "session/statistics.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

struct FeelOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file
    std::vector<std::string> ranges{"20:3000", "50:10000", "200:5000"};  // pN
    std::vector<double> tolerances_pN{50, 150, 500};
    std::size_t samples = 20;  // of a stroke
    bool json = false;
};

struct FeelResult {
    std::array<double, 2> range_pN{};
    double within_pN = 0;
    Summary summary;
    double largest_hand_N = 0;  // sent
    // Of each sample: the force that the servo told less the reference's.
    std::vector<double> errors_pN;
    double ninety_pN = 0, within_share = 0;
    double moving_pN = 0;  // by which the last quarter of a reference still changed it, median

    // What is asked, and where it is not so and the run did not say that it gave way, in words.
    std::vector<std::string> unsaid() const;
};

// Throws LoadError on bad input. Returns the exit code: 1 where something was not so and nothing
// was said to give way.
int feel_command(const FeelOptions& options);

}  // namespace palpa
