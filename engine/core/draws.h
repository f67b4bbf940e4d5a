// Random numbers from a seed, the same on every machine: distributions of the library are not.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>

namespace palpa {

class Draws {
public:
    // Each number of a seed is a row of its own.
    Draws(std::uint64_t seed, std::uint64_t number) : random_(seed * 1'000'003 + number) {}

    double between(double low, double high) { return low + (high - low) * share(); }
    // Equally often in every decade.
    double scale(double low, double high) {
        return std::exp(between(std::log(low), std::log(high)));
    }
    std::size_t below(std::size_t count) { return random_() % count; }

    // Mean 0, standard deviation 1: two at a time, by Box and Muller.
    double normal() {
        if (spare_) {
            const double kept = *spare_;
            spare_.reset();
            return kept;
        }
        const double radius = std::sqrt(-2 * std::log(1 - share()));
        const double angle = 2 * std::numbers::pi * share();
        spare_ = radius * std::sin(angle);
        return radius * std::cos(angle);
    }

private:
    // From 0 to 1, without 1.
    double share() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

    std::mt19937_64 random_;
    std::optional<double> spare_;
};

}  // namespace palpa
