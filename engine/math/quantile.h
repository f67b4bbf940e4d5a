// The value that a share of samples is below.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace palpa {

// Of at least one sample, at the nearest rank. The median for a share of 0.5.
inline double quantile(std::vector<double> samples, double share) {
    const auto rank = std::lround(share * static_cast<double>(samples.size() - 1));
    std::nth_element(samples.begin(), samples.begin() + rank, samples.end());
    return samples[static_cast<std::size_t>(rank)];
}

}  // namespace palpa
