#include "core/draws.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

using namespace palpa;

TEST_CASE("draws are those of the generator that the C++ standard defines", "[core][draws]") {
    // The standard's own number: the 10000th of mt19937_64, whose seed is 5489 unless told.
    constexpr std::uint64_t ten_thousandth = 9981545732273789042U;
    Draws whole(0, 5489), share(0, 5489);
    for (int i = 1; i < 10000; ++i) {
        (void)whole.below(2);
        (void)share.between(0, 1);
    }

    CHECK(whole.below(1'000'003) == ten_thousandth % 1'000'003);
    CHECK(share.between(0, 1) == Approx(static_cast<double>(ten_thousandth) * 0x1p-64));
}

TEST_CASE("normal draws have the moments and the tail of the normal distribution",
          "[core][draws]") {
    constexpr int count = 200'000;
    Draws draws(1, 0);
    double sum = 0, squares = 0, fourths = 0, neighbours = 0, last = 0;
    int beyond = 0;

    for (int i = 0; i < count; ++i) {
        const double x = draws.normal();
        sum += x;
        squares += x * x;
        fourths += x * x * x * x;
        neighbours += x * last;
        if (x > 1) ++beyond;
        last = x;
    }

    // Four standard errors each: those of x, x^2, x^4, x y and of a share.
    const double root = std::sqrt(count);
    CHECK(std::abs(sum / count) < 4 / root);
    CHECK(std::abs(squares / count - 1) < 4 * std::sqrt(2) / root);
    CHECK(std::abs(fourths / count - 3) < 4 * std::sqrt(96) / root);
    CHECK(std::abs(neighbours / count) < 4 / root);
    CHECK(std::abs(static_cast<double>(beyond) / count - 0.158655) < 4 * 0.3654 / root);
}
