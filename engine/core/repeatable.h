// Elementary functions for all that decides where molecules and hands go. They are made of sums,
// products, quotients and roots in double, which every processor, compiler and system rounds alike;
// the last digits of the standard library's functions depend on all three. The error is at most
// five units in the last place, and at most 1e-20 near the zeros of sine and cosine. Beyond a
// million radians sine and cosine are less exact.
#pragma once

namespace palpa::repeatable {

double exp(double x) noexcept;
double expm1(double x) noexcept;
double log(double x) noexcept;
double sin(double x) noexcept;
double cos(double x) noexcept;
double atan(double x) noexcept;
double atan2(double y, double x) noexcept;
double hypot(double x, double y) noexcept;

}  // namespace palpa::repeatable
