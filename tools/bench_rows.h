// What palpa bench prints: a line a measurement.
#pragma once
#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct BenchRow {
    std::string name;
    std::vector<double> samples;  // in `unit`
    std::string unit;
    std::optional<double> error;
    std::string error_unit, reference;
};

template <class Work>
double seconds_of(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace palpa
