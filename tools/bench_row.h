// One line of palpa bench, and how its samples are taken.
#pragma once
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct BenchRow {
    std::string name;
    std::vector<double> samples;  // in `unit`
    std::string unit;
    std::optional<double> error = {};
    std::string error_unit = {}, reference = {};
};

template <class Work>
double seconds_of(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// What the work took, `runs` times: seconds if `per_second` is 1, ms if it is 1e3.
template <class Work>
std::vector<double> sample(int runs, double per_second, const Work& work) {
    std::vector<double> samples;
    for (int run = 0; run < runs; ++run) samples.push_back(per_second * seconds_of(work));
    return samples;
}

// The median for a share of 0.5.
inline double quantile(std::vector<double> samples, double share) {
    const auto rank = std::lround(share * static_cast<double>(samples.size() - 1));
    std::nth_element(samples.begin(), samples.begin() + rank, samples.end());
    return samples[static_cast<std::size_t>(rank)];
}

}  // namespace palpa
