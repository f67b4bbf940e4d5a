#include "haptics/gains.h"

#include "core/repeatable.h"
#include "math/eigenvectors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpa {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

// d atan(x)/dx
double lorentzian(double x) noexcept { return 1.0 / (1.0 + x * x); }

struct ValueAndSlope {
    double value, slope;
};

// Where a function that increases through 0 above `low` does so, by Newton's steps. One that leaves
// what is known to hold the root halves that, or doubles x while nothing bounds it above.
template <class Function>
double increasing_root(const Function& function, double x, double low) noexcept {
    constexpr int most = 1200;  // doublings and halvings through all exponents of a double
    double high = infinity;
    for (int i = 0; i < most; ++i) {
        const ValueAndSlope f = function(x);
        if (f.value == 0) return x;
        (f.value < 0 ? low : high) = x;
        double next = x - f.value / f.slope;
        if (std::abs(next - x) <= 4e-16 * std::abs(x)) return next;
        if (!(next > low && next < high)) {
            next = high < infinity ? low + (high - low) / 2 : 2 * x;
            if (next == low || next == high) return x;
        }
        x = next;
    }
    return x;
}

// The perceptual law's joint reaches this far to both sides of F_lo, in ln F: a factor of 2.
constexpr double joint = std::numbers::ln2;

}  // namespace

PrintedForceLaw::PrintedForceLaw(const Parameters& p) noexcept
    : alpha_1_(p.F_h1 / (pi / 2)),
      alpha_2_((p.F_h2 - p.F_h1) / pi),
      delta_1_(p.A_fmax / alpha_1_),
      delta_2_(p.A_fmin / (2 * alpha_2_)),
      F_0_(p.F_0) {}

std::optional<PrintedForceLaw> PrintedForceLaw::find_calibrated(const Parameters& p) noexcept {
    const bool positive =
        p.F_h1 > 0 && p.F_h2 > p.F_h1 && p.F_0 > 0 && p.A_fmin > 0 && p.A_fmax > 0;
    if (!positive || !std::isfinite(p.F_h2 + p.F_0 + p.A_fmin + p.A_fmax)) return std::nullopt;
    PrintedForceLaw law(p);
    // In u = δ1 F_0 and v = δ2 F_0. The slope at 0 gives u(v); the slope at F_0 then increases with
    // v wherever u > 1, and is enough at v = A_fmin F_0/α2.
    const double a1 = law.alpha_1_, a2 = law.alpha_2_;
    const double low_slope = p.A_fmax * p.F_0, high_slope = p.A_fmin * p.F_0;
    if (!(low_slope >= a1 + a2)) return std::nullopt;
    const auto u_of = [&](double v) { return (low_slope - 2 * a2 * v * lorentzian(v)) / a1; };
    const auto excess_slope = [&](double v) {
        const double u = u_of(v), l_u = lorentzian(u), l_v = lorentzian(v);
        const double l_2v = lorentzian(2 * v);
        const double du_dv = -2 * a2 / a1 * (1 - v * v) * l_v * l_v;
        return ValueAndSlope{
            a1 * u * l_u + a2 * v * (1 + l_2v) - high_slope,
            a1 * (1 - u * u) * l_u * l_u * du_dv + a2 * (1 + (1 - 4 * v * v) * l_2v * l_2v)};
    };
    if (!(excess_slope(0).value < 0)) return std::nullopt;
    const double v = increasing_root(excess_slope, high_slope / a2, 0);
    law.delta_1_ = u_of(v) / p.F_0;
    law.delta_2_ = v / p.F_0;
    return law;
}

double PrintedForceLaw::value(double F_m) const noexcept {
    return alpha_1_ * repeatable::atan(delta_1_ * F_m) +
           alpha_2_ * (repeatable::atan(delta_2_ * (F_m - F_0_)) +
                       repeatable::atan(delta_2_ * (F_m + F_0_)));
}

double PrintedForceLaw::slope(double F_m) const noexcept {
    return alpha_1_ * delta_1_ * lorentzian(delta_1_ * F_m) +
           alpha_2_ * delta_2_ *
               (lorentzian(delta_2_ * (F_m - F_0_)) + lorentzian(delta_2_ * (F_m + F_0_)));
}

PerceptualForceLaw::PerceptualForceLaw(const Parameters& p) noexcept
    : F_lo_(p.F_lo),
      F_hi_(p.F_hi),
      F_h_lo_(p.F_h_lo),
      F_h_hi_(p.F_h_hi),
      F_h_limit_(p.F_h_limit),
      exponent_(repeatable::log(p.F_h_hi / p.F_h_lo) / repeatable::log(p.F_hi / p.F_lo)),
      slope_at_hi_(exponent_ * p.F_h_hi / p.F_hi) {}

PerceptualForceLaw PerceptualForceLaw::for_range(double F_lo, double F_hi) noexcept {
    // Rounding is not to take the weakest below what must be felt of it.
    constexpr double rounding = 1e-14;
    const double ratio = F_hi / F_lo;
    const double power =
        std::min(1.0, repeatable::log(most_felt / least_felt) / repeatable::log(ratio));
    const double joint_at = F_lo / 2;
    return PerceptualForceLaw(
        {.F_lo = joint_at,
         .F_hi = F_hi,
         .F_h_lo =
             most_felt * repeatable::exp(power * repeatable::log(joint_at / F_hi)) * (1 + rounding),
         .F_h_hi = most_felt,
         .F_h_limit = truncation_newton});
}

double PerceptualForceLaw::value(double F_m) const noexcept {
    const double F = std::abs(F_m);
    if (F >= F_hi_) {
        const double room = F_h_limit_ - F_h_hi_;
        const double above = room - room / (1 + slope_at_hi_ * (F - F_hi_) / room);
        return std::copysign(F_h_hi_ + above, F_m);
    }
    const double x = repeatable::log(F / F_lo_);
    if (!(x > -joint)) return F_h_lo_ / F_lo_ * F_m;
    const double into = x + joint;
    const double y = x < joint ? x - (1 - exponent_) / (4 * joint) * into * into : exponent_ * x;
    return std::copysign(F_h_lo_ * repeatable::exp(y), F_m);
}

double PerceptualForceLaw::slope(double F_m) const noexcept {
    const double F = std::abs(F_m);
    if (F >= F_hi_) {
        const double t = 1 + slope_at_hi_ * (F - F_hi_) / (F_h_limit_ - F_h_hi_);
        return slope_at_hi_ / (t * t);
    }
    const double x = repeatable::log(F / F_lo_);
    if (!(x > -joint)) return F_h_lo_ / F_lo_;
    const double exponent = x < joint ? 1 - (1 - exponent_) / (2 * joint) * (x + joint) : exponent_;
    return exponent * value(F) / F;
}

double hand_force(const ForceLaw& law, double F_m) noexcept {
    return std::visit([F_m](const auto& l) { return l.value(F_m); }, law);
}

Vec3 hand_force(const ForceLaw& law, const Vec3& force_newton) noexcept {
    const double norm = force_newton.norm();  // stableNorm drops what is no number
    if (norm == 0) return Vec3::Zero();
    return force_newton * (hand_force(law, norm) / norm);
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

Mat3 force_jacobian(const ForceLaw& law, const Vec3& force_newton) noexcept {
    const double F_m = force_newton.norm();
    const double slope = hand_force_slope(law, F_m);
    if (F_m == 0) return slope * Mat3::Identity();
    const double gain = force_gain(law, F_m);
    const Vec3 along = force_newton / F_m;
    return gain * Mat3::Identity() + (slope - gain) * along * along.transpose();
}

double largest_felt(const ForceLaw& law, const Vec3& force_newton, const Mat3& stiffness) noexcept {
    return largest_felt(force_jacobian(law, force_newton) * stiffness);
}

double largest_felt(const Mat3& felt) noexcept {
    if (!felt.allFinite()) return infinity;
    return std::max(0.0, find_eigenvalues(0.5 * (felt + felt.transpose())).maxCoeff());
}

PrintedDisplacementLaw::PrintedDisplacementLaw(const Parameters& p) noexcept
    : A_dmin_(p.A_dmin),
      beta_((p.A_dmax - p.A_dmin) / (pi / 2 - repeatable::atan(-p.gamma * p.F_off))),
      gamma_(p.gamma),
      F_off_(p.F_off),
      atan_at_0_(repeatable::atan(-p.F_off * p.gamma)) {}

double PrintedDisplacementLaw::value(double F_m, double /*stiffness*/) const noexcept {
    return A_dmin_ + beta_ * (repeatable::atan((std::abs(F_m) - F_off_) * gamma_) - atan_at_0_);
}

RepairedDisplacementLaw::RepairedDisplacementLaw(const Parameters& p) noexcept
    : printed_(p.printed), length_m_(p.length_m) {}

double RepairedDisplacementLaw::value(double F_m, double stiffness) const noexcept {
    return printed_.value(repeatable::hypot(F_m, length_m_ * stiffness));
}

double displacement_gain(const DisplacementLaw& law, double F_m, double stiffness) noexcept {
    return std::visit([=](const auto& l) { return l.value(F_m, stiffness); }, law);
}

double capped_gain(double A_d, double felt, double K_cap) noexcept {
    return std::max(A_d, felt / K_cap);
}

}  // namespace palpa
