// The coupling laws: molecular force to hand force, handle travel to molecule travel. SI units.
#pragma once
#include "core/omni.h"
#include "math/vec.h"

#include <optional>
#include <variant>

namespace palpa {

// Eq. 2 of the paper as printed: F_h = α1 atan(δ1 F) + α2 [atan(δ2 (F - F0)) + atan(δ2 (F + F0))].
// Odd in F to the last bit, monotone, tends to ±F_h2. As printed its slope at 0 is 8 % above A_fmax
// and at F_0 29 % below A_fmin.
class PrintedForceLaw {
public:
    struct Parameters {
        double F_h1 = 1.0;                // N, limit for weak forces
        double F_h2 = truncation_newton;  // N, limit for strong forces; > F_h1
        double F_0 = 1.5e-9;              // N, between weak and strong molecular forces
        double A_fmin = 0.64e9;           // gain of strong forces
        double A_fmax = 5.1e9;            // gain of weak forces
    };

    explicit PrintedForceLaw(const Parameters& parameters) noexcept;

    // The same form with other δ1 and δ2: the slope is A_fmax at 0 and A_fmin at F_0. Nothing
    // unless 0 < F_h1 < F_h2, the gains and F_0 are positive, low forces have their say below F_0
    // (A_fmax F_0 >= α1 + α2, so that there is at most one solution) and alone leave a slope below
    // A_fmin there.
    static std::optional<PrintedForceLaw> find_calibrated(const Parameters& parameters) noexcept;

    double value(double F_m) const noexcept;  // N
    double slope(double F_m) const noexcept;  // dF_h/dF_m

private:
    double alpha_1_, alpha_2_;  // N
    double delta_1_, delta_2_;  // 1/N
    double F_0_;                // N
};

// F_h = gain F_m; a gain of 0 is the mode without force.
struct ConstantForceLaw {
    double gain = 0;

    double value(double F_m) const noexcept { return gain * F_m; }
    double slope(double /*F_m*/) const noexcept { return gain; }
};

// Equally many noticeable steps for each decade of F_m. A just noticeable step is 9 % of the force,
// but 0.05 N at least: below `F_h_lo` steps are nearly equal in newtons and the law is linear, from
// there to (F_hi, F_h_hi) it is the power law φ = F_h_lo (F/F_lo)^p, p = log10(F_h_hi/F_h_lo)/n,
// n = log10(F_hi/F_lo). These meet in a kink at F_lo; a parabola in log φ over log F goes from one
// exponent to the other between F_lo/2 and 2 F_lo. Its φ(F_lo) is 0.27 N instead of 0.3 N, less
// than a step. Above F_hi it tends to F_h_limit, without a kink. Odd, monotone; value and slope are
// continuous.
class PerceptualForceLaw {
public:
    // By default what a hand can distinguish from no force is what eq. 3 calls near (F_off); a hand
    // on eq. 2 hardly goes above 3 nN. Between, the attraction of two waters (0.32 nN) feels
    // like 1.1 N.
    struct Parameters {
        double F_lo = 20e-12;                 // N
        double F_hi = 3e-9;                   // N, > 2 F_lo
        double F_h_lo = 0.3;                  // N
        double F_h_hi = truncation_newton;    // N
        double F_h_limit = omni_peak_newton;  // N, > F_h_hi
    };

    explicit PerceptualForceLaw(const Parameters& parameters) noexcept;

    // For forces that must be felt, 0 < F_lo < F_hi (N): at F_lo `least_felt` or more, at F_hi
    // `most_felt`, above that less than `truncation_newton`. Its joint is wholly below F_lo. Where
    // F_hi is less than 9 F_lo it would take a power above 1, so the law is linear there.
    static PerceptualForceLaw for_range(double F_lo, double F_hi) noexcept;
    static constexpr double least_felt = 0.3, most_felt = 2.7;  // N

    double value(double F_m) const noexcept;  // N
    double slope(double F_m) const noexcept;  // dF_h/dF_m

private:
    double F_lo_, F_hi_;                  // N
    double F_h_lo_, F_h_hi_, F_h_limit_;  // N
    double exponent_;                     // p
    double slope_at_hi_;
};

using ForceLaw = std::variant<PrintedForceLaw, ConstantForceLaw, PerceptualForceLaw>;

// Force on the hand (N) for the molecular force F_m (N) along one direction, and its derivative.
double hand_force(const ForceLaw& law, double F_m) noexcept;
double hand_force_slope(const ForceLaw& law, double F_m) noexcept;
// In space the law acts on the norm of the force, along its direction. NaN stays NaN.
Vec3 hand_force(const ForceLaw& law, const Vec3& force_newton) noexcept;
// The gain F_h/F_m at F_m; at F_m = 0 its limit, the slope.
double force_gain(const ForceLaw& law, double F_m) noexcept;

// Derivative of the hand force in space, where the law acts on the norm along the force: its slope
// along the force, its gain across.
Mat3 force_jacobian(const ForceLaw& law, const Vec3& force_newton) noexcept;
// The stiffest that a hand feels a molecular stiffness (N/m) in any direction, times A_d: the
// largest eigenvalue of the symmetric part of jacobian times stiffness, 0 where it is negative.
// Infinite where force or stiffness are not finite: then the capped gain lets nothing move.
double largest_felt(const Mat3& felt) noexcept;  // from that product
double largest_felt(const ForceLaw& law, const Vec3& force_newton, const Mat3& stiffness) noexcept;

// Eq. 3 of the paper as printed: A_d = A_dmin + β [atan((|F| - F_off) γ) - atan(-F_off γ)], handle
// metres per molecule metre. A_d(0) is A_dmin to the last bit, the limit is A_dmax.
class PrintedDisplacementLaw {
public:
    struct Parameters {
        double gamma = 10e11;     // 1/N, sharpness of the transition
        double F_off = 20e-12;    // N, force of the transition
        double A_dmin = 0.005e9;  // far from everything
        double A_dmax = 0.25e9;   // in contact
    };

    explicit PrintedDisplacementLaw(const Parameters& parameters) noexcept;

    double value(double F_m, double stiffness = 0) const noexcept;

private:
    double A_dmin_, beta_, gamma_, F_off_, atan_at_0_;
};

// Eq. 3 at sqrt(F² + (l k)²), k the stiffness (N/m): as printed the gain also falls to A_dmin at
// the equilibrium in contact, where there is no force but a stiff place.
class RepairedDisplacementLaw {
public:
    struct Parameters {
        PrintedDisplacementLaw::Parameters printed = {};
        double length_m = 5e-12;  // l: the stiffness counts as much as its force over this way
    };

    explicit RepairedDisplacementLaw(const Parameters& parameters) noexcept;

    double value(double F_m, double stiffness = 0) const noexcept;

private:
    PrintedDisplacementLaw printed_;
    double length_m_;
};

// One gain everywhere, as in the paper's modes 2, 4 and 5.
struct ConstantDisplacementLaw {
    double gain = 0.25e9;

    double value(double /*F_m*/, double /*stiffness*/ = 0) const noexcept { return gain; }
};

using DisplacementLaw =
    std::variant<PrintedDisplacementLaw, ConstantDisplacementLaw, RepairedDisplacementLaw>;

// A_d, handle metres per molecule metre, where the molecular force is F_m (N). In space `stiffness`
// is the largest |eigenvalue| (N/m) of the molecular one; only the repaired law looks at it.
double displacement_gain(const DisplacementLaw& law, double F_m, double stiffness = 0) noexcept;

// A_d raised until the felt stiffness is K_cap (N/m, > 0) at most. `felt` is that stiffness times
// A_d: slope times stiffness along a line, largest_felt() in space.
double capped_gain(double A_d, double felt, double K_cap) noexcept;

// Both laws of the coupling.
struct CouplingLaws {
    ForceLaw force;
    DisplacementLaw displacement;
};

}  // namespace palpa
