#include "core/repeatable.h"
#include "core/draws.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// How far `value` is from `expected`, in units of its last place.
double units_between(double value, double expected) {
    const double size = std::abs(expected);
    return std::abs(value - expected) / (std::nextafter(size, infinity) - size);
}

}  // namespace

TEST_CASE("repeatable functions are within five units in the last place of the library's",
          "[core]") {
    struct Function {
        std::string name;
        std::function<double(double)> own, library;
        double least, most;  // arguments
    };
    const std::vector<Function> functions{
        {"exp", repeatable::exp, [](double x) { return std::exp(x); }, -700, 700},
        {"exp", repeatable::exp, [](double x) { return std::exp(x); }, -2, 2},
        {"expm1", repeatable::expm1, [](double x) { return std::expm1(x); }, -1, 1},
        {"log", repeatable::log, [](double x) { return std::log(x); }, 1e-300, 1e-3},
        {"log", repeatable::log, [](double x) { return std::log(x); }, 0.5, 2},
        {"log", repeatable::log, [](double x) { return std::log(x); }, 2, 1e9},
        {"sin", repeatable::sin, [](double x) { return std::sin(x); }, -10, 10},
        {"cos", repeatable::cos, [](double x) { return std::cos(x); }, -10, 10},
        {"sin", repeatable::sin, [](double x) { return std::sin(x); }, -9e5, 9e5},
        {"cos", repeatable::cos, [](double x) { return std::cos(x); }, -9e5, 9e5},
        {"atan", repeatable::atan, [](double x) { return std::atan(x); }, -4, 4},
        {"atan", repeatable::atan, [](double x) { return std::atan(x); }, -1e6, 1e6},
        {"atan2, ahead", [](double y) { return repeatable::atan2(y, 0.7); },
         [](double y) { return std::atan2(y, 0.7); }, -3, 3},
        {"atan2, behind", [](double y) { return repeatable::atan2(y, -0.7); },
         [](double y) { return std::atan2(y, -0.7); }, -3, 3},
        {"hypot", [](double y) { return repeatable::hypot(0.7, y); },
         [](double y) { return std::hypot(0.7, y); }, -3, 3}};
    Draws draws(1, 1);
    for (const Function& function : functions) {
        double worst = 0;
        for (int i = 0; i < 100'000; ++i) {
            const double x = draws.between(function.least, function.most);
            worst = std::max(worst, units_between(function.own(x), function.library(x)));
        }
        INFO(function.name << " from " << function.least << " to " << function.most);
        CHECK(worst <= 5);
    }
}

TEST_CASE("repeatable sine and cosine are exact to 1e-20 near their zeros", "[core]") {
    for (int n = -100'000; n <= 100'000; n += 7) {
        const double x = n * (std::numbers::pi / 2);
        const bool is_sine = n % 2 == 0;
        const double own = is_sine ? repeatable::sin(x) : repeatable::cos(x);
        CHECK(std::abs(own - (is_sine ? std::sin(x) : std::cos(x))) < 1e-20);
    }
}

TEST_CASE("repeatable functions have the library's values at the ends of their range", "[core]") {
    CHECK(repeatable::exp(0) == 1);
    CHECK(repeatable::exp(-infinity) == 0);
    CHECK(repeatable::exp(-746) == 0);
    CHECK(repeatable::exp(-745) == std::exp(-745));
    CHECK(repeatable::exp(710) == infinity);
    CHECK(std::isnan(repeatable::exp(std::nan(""))));
    CHECK(repeatable::expm1(0) == 0);
    CHECK(repeatable::log(1) == 0);
    CHECK(repeatable::log(0) == -infinity);
    CHECK(repeatable::log(infinity) == infinity);
    CHECK(std::isnan(repeatable::log(-1)));
    CHECK(std::isnan(repeatable::log(std::nan(""))));
    CHECK(repeatable::sin(0) == 0);
    CHECK(repeatable::cos(0) == 1);
    CHECK(std::abs(repeatable::sin(1e300)) <= 1);
    CHECK(std::isnan(repeatable::cos(infinity)));
    CHECK(repeatable::atan(infinity) == std::numbers::pi / 2);
    CHECK(std::signbit(repeatable::atan(-0.0)));
    CHECK(std::isnan(repeatable::atan(std::nan(""))));
    for (const double y : {0.0, -0.0, 1.0, -1.0}) {
        for (const double x : {0.0, -0.0, 1.0, -1.0}) {
            INFO("atan2 of " << y << " and " << x);
            CHECK(repeatable::atan2(y, x) == std::atan2(y, x));
        }
    }
    CHECK(std::isnan(repeatable::atan2(std::nan(""), 1)));
    CHECK(std::isnan(repeatable::atan2(0, std::nan(""))));
    CHECK(repeatable::hypot(0, 0) == 0);
    CHECK(repeatable::hypot(-3e300, 4e300) == 5e300);
    CHECK(repeatable::hypot(1, infinity) == infinity);
    CHECK(std::isnan(repeatable::hypot(std::nan(""), 1)));
    CHECK(std::isnan(repeatable::hypot(1, std::nan(""))));
}
