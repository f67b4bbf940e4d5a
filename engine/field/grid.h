// Splits coordinates into two single-precision parts.
#pragma once
#include <cstdint>

namespace palpa {

// Rounds to multiples of 2^-10; beyond 2^42 a double has no finer ones.
inline double rounded_to_grid(double x) noexcept {
    constexpr double shift = 1.5 * (std::uint64_t{1} << 42);
    return (x + shift) - shift;
}

}  // namespace palpa
