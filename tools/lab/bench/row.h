// One line of palpa-lab bench, and how its samples are taken.
#pragma once
#include "math/quantile.h"

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

struct BenchRow {
    std::string name;
    std::vector<double> samples;  // in `unit`
    std::string unit;
    std::optional<double> error = {};
    std::string error_unit = {}, reference = {};
    std::vector<std::pair<std::string, double>> more = {};  // in JSON, by these keys
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

}  // namespace palpa
