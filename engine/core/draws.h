// Random numbers from a seed, identical on every machine (the standard library's distributions are
// not). Make one draw per statement: C++ does not fix the order within an expression.
#pragma once
#include "core/repeatable.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>

namespace palpa {

class Draws {
public:
    // Each `number` of a seed gives an independent sequence.
    Draws(std::uint64_t seed, std::uint64_t number) : random_(seed * 1'000'003 + number) {}

    double between(double low, double high) { return low + (high - low) * share(); }
    // Uniform in the logarithm between low and high.
    double scale(double low, double high) {
        return repeatable::exp(between(repeatable::log(low), repeatable::log(high)));
    }
    std::size_t below(std::size_t count) { return random_() % count; }

    // Normal distribution with mean 0 and standard deviation 1 (Box-Muller).
    double normal() {
        if (spare_) {
            const double kept = *spare_;
            spare_.reset();
            return kept;
        }
        const double radius = std::sqrt(-2 * repeatable::log(1 - share()));
        const double angle = 2 * std::numbers::pi * share();
        spare_ = radius * repeatable::sin(angle);
        return radius * repeatable::cos(angle);
    }

private:
    // Uniform from 0 (included) to 1 (excluded).
    double share() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

    std::mt19937_64 random_;
    std::optional<double> spare_;
};

}  // namespace palpa
