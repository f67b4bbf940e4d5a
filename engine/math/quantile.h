// Quantiles of samples.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace palpa {

// The quantile at `share` by the nearest rank; 0.5 gives the median. Needs at least one sample.
inline double quantile(std::vector<double> samples, double share) {
    const auto rank = std::lround(share * static_cast<double>(samples.size() - 1));
    std::nth_element(samples.begin(), samples.begin() + rank, samples.end());
    return samples[static_cast<std::size_t>(rank)];
}

}  // namespace palpa
