#include "haptics/gains.h"

#include <cmath>
#include <numbers>

namespace palpa {
namespace {

constexpr double pi = std::numbers::pi;

// d atan(x)/dx
double lorentzian(double x) noexcept { return 1.0 / (1.0 + x * x); }

}  // namespace

PrintedForceLaw::PrintedForceLaw(const Parameters& p) noexcept
    : alpha_1_(p.F_h1 / (pi / 2)),
      alpha_2_((p.F_h2 - p.F_h1) / pi),
      delta_1_(p.A_fmax / alpha_1_),
      delta_2_(p.A_fmin / (2 * alpha_2_)),
      F_0_(p.F_0) {}

double PrintedForceLaw::value(double F_m) const noexcept {
    return alpha_1_ * std::atan(delta_1_ * F_m) +
           alpha_2_ * (std::atan(delta_2_ * (F_m - F_0_)) + std::atan(delta_2_ * (F_m + F_0_)));
}

double PrintedForceLaw::slope(double F_m) const noexcept {
    return alpha_1_ * delta_1_ * lorentzian(delta_1_ * F_m) +
           alpha_2_ * delta_2_ *
               (lorentzian(delta_2_ * (F_m - F_0_)) + lorentzian(delta_2_ * (F_m + F_0_)));
}

double hand_force(const ForceLaw& law, double F_m) noexcept {
    return std::visit([F_m](const auto& l) { return l.value(F_m); }, law);
}

double hand_force_slope(const ForceLaw& law, double F_m) noexcept {
    return std::visit([F_m](const auto& l) { return l.slope(F_m); }, law);
}

double force_gain(const ForceLaw& law, double F_m) noexcept {
    // Nearer to 0 the arctangents of eq. 2 cancel, and the quotient is the slope to 12 digits
    // anyway.
    constexpr double smallest = 1e-16;  // N
    return std::abs(F_m) < smallest ? hand_force_slope(law, 0) : hand_force(law, F_m) / F_m;
}

PrintedDisplacementLaw::PrintedDisplacementLaw(const Parameters& p) noexcept
    : A_dmin_(p.A_dmin),
      beta_((p.A_dmax - p.A_dmin) / (pi / 2 - std::atan(-p.gamma * p.F_off))),
      gamma_(p.gamma),
      F_off_(p.F_off),
      atan_at_0_(std::atan(-p.F_off * p.gamma)) {}

double PrintedDisplacementLaw::value(double F_m) const noexcept {
    return A_dmin_ + beta_ * (std::atan((std::abs(F_m) - F_off_) * gamma_) - atan_at_0_);
}

double PrintedDisplacementLaw::slope(double F_m) const noexcept {
    if (F_m == 0) return 0;
    return std::copysign(beta_ * gamma_ * lorentzian((std::abs(F_m) - F_off_) * gamma_), F_m);
}

double displacement_gain(const DisplacementLaw& law, double F_m) noexcept {
    return std::visit([F_m](const auto& l) { return l.value(F_m); }, law);
}

}  // namespace palpa
