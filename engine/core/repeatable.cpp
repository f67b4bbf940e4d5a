#include "core/repeatable.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

// Arguments are brought near to zero, where Taylor's series are short. What a constant's double
// leaves over is in a second one.
namespace palpa::repeatable {
namespace {

constexpr double pi = std::numbers::pi, pi_rest = 1.2246467991473532e-16;
constexpr double infinity = std::numeric_limits<double>::infinity();
// The products of the first ones with whole numbers of up to a million are exact.
constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;
constexpr double half_pi_high = 0x1.921fb544p+0, half_pi_low = 0x1.0b4611a626331p-34;

// The whole number next to x, of up to a million.
double whole(double x) noexcept {
    constexpr double shift = 0x1.8p52;  // what is added to it is rounded so
    return (x + shift) - shift;
}

// Returns x 2^n.
double scaled(double x, int n) noexcept {
    if (n < -1000 || n > 1000) return std::ldexp(x, n);
    return x * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + n) << 52U);
}

// The polynomial with these coefficients, the constant first.
template <std::size_t n>
double polynomial(const std::array<double, n>& c, double x) noexcept {
    double sum = c[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) sum = sum * x + c[i];
    return sum;
}

// exp(x) - 1 - x, for x within 0.35 of zero.
double exp_rest(double x) noexcept {
    static constexpr std::array c{1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,
                                  1.0 / 720,     1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                  1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
    return x * x * polynomial(c, x);
}

// x as a number of quarter turns, of which the last two bits count, and an angle within pi/4 of
// zero.
struct Quarters {
    double angle, angle_rest;
    int count;
};

Quarters split(double x) noexcept {
    if (std::abs(x) > 1e6) x = std::remainder(x, 2 * pi);
    const double n = whole(x * (2 / pi));
    const double high = x - n * half_pi_high, low = n * half_pi_low, angle = high - low;
    return {angle, (high - angle) - low, std::isfinite(n) ? static_cast<int>(n) & 3 : 0};
}

double sin_of_rest(const Quarters& x) noexcept {
    static constexpr std::array c{
        -1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
        -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
    const double z = x.angle * x.angle;
    return x.angle + (x.angle * z * polynomial(c, z) + x.angle_rest * (1 - z / 2));
}

double cos_of_rest(const Quarters& x) noexcept {
    static constexpr std::array c{
        1.0 / 24,        -1.0 / 720,         1.0 / 40320,         -1.0 / 3628800,
        1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000};
    const double z = x.angle * x.angle, left = 1 - z / 2;
    return left + ((1 - left - z / 2) + (z * z * polynomial(c, z) - x.angle * x.angle_rest));
}

}  // namespace

double exp(double x) noexcept {
    if (std::isnan(x)) return x;
    if (std::abs(x) > 745.5) return x > 0 ? infinity : 0;
    const double n = whole(x * std::numbers::log2e);
    const double high = x - n * ln2_high, low = n * ln2_low, rest = high - low;
    return scaled(1 + (((high - rest) - low) + exp_rest(rest) + rest), static_cast<int>(n));
}

double expm1(double x) noexcept { return std::abs(x) < 0.35 ? x + exp_rest(x) : exp(x) - 1; }

double log(double x) noexcept {
    static constexpr std::array c{2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                                  2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
    if (x == 0) return -infinity;
    if (x < 0) return std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(x)) return x;
    int n = 0;
    double m = std::frexp(x, &n);
    if (m < 1 / std::numbers::sqrt2) {
        m *= 2;
        --n;
    }
    // The series in s, where m = (1 + s)/(1 - s).
    const double f = m - 1, s = f / (2 + f), z = s * s, square = f * f / 2;
    const double sum = s * (square + z * polynomial(c, z)) + n * ln2_low;
    return n * ln2_high - ((square - sum) - f);
}

double sin(double x) noexcept {
    const Quarters rest = split(x);
    const double value = rest.count % 2 == 0 ? sin_of_rest(rest) : cos_of_rest(rest);
    return rest.count < 2 ? value : -value;
}

double cos(double x) noexcept {
    const Quarters rest = split(x);
    const double value = rest.count % 2 == 0 ? cos_of_rest(rest) : sin_of_rest(rest);
    return rest.count == 0 || rest.count == 3 ? value : -value;
}

double atan(double x) noexcept {
    static constexpr std::array c{1.0 / 3,  -1.0 / 5,  1.0 / 7, -1.0 / 9,
                                  1.0 / 11, -1.0 / 13, 1.0 / 15};
    // The angles of the tangents 0, 1/8 ... 1.
    static constexpr std::array angles{0.0,
                                       0x1.fd5ba9aac2f6ep-4,
                                       0x1.f5b75f92c80ddp-3,
                                       0x1.6f61941e4def1p-2,
                                       0x1.dac670561bb4fp-2,
                                       0x1.1e00babdefeb4p-1,
                                       0x1.4978fa3269ee1p-1,
                                       0x1.700a7c5784634p-1,
                                       0x1.921fb54442d18p-1};
    static constexpr std::array angle_rests{0.0,
                                            -0x1.cd37686760c17p-59,
                                            0x1.8ab6e3cf7afbdp-57,
                                            -0x1.c63aae6f6e918p-56,
                                            0x1.a2b7f222f65e2p-56,
                                            -0x1.928df287a668fp-58,
                                            0x1.2419a87f2a458p-56,
                                            -0x1.8c34d25aadef6p-56,
                                            0x1.1a62633145c07p-55};
    const double size = std::abs(x);
    if (std::isnan(size)) return x;
    if (size > 1) return std::copysign(pi / 2 - (atan(1 / size) - pi_rest / 2), x);
    const double near = whole(8 * size), tangent = near / 8;
    const double t = (size - tangent) / (1 + size * tangent), z = t * t;
    const auto at = static_cast<std::size_t>(near);
    return std::copysign(angles[at] + (t - (t * z * polynomial(c, z) - angle_rests[at])), x);
}

double atan2(double y, double x) noexcept {
    const double right = std::abs(x), up = std::abs(y);
    if (up > right)
        return std::copysign(pi / 2 - (std::copysign(atan(right / up), x) - pi_rest / 2), y);
    const double angle = up == 0 && right == 0 ? 0 : atan(up / right);
    return std::copysign(std::signbit(x) ? pi - (angle - pi_rest) : angle, y);
}

double hypot(double x, double y) noexcept {
    if (std::isnan(x) || std::isnan(y)) return x + y;
    const double most = std::max(std::abs(x), std::abs(y)),
                 least = std::min(std::abs(x), std::abs(y));
    if (most == 0 || !std::isfinite(most)) return most + least;
    const double share = least / most;
    return most * std::sqrt(1 + share * share);
}

}  // namespace palpa::repeatable
