// The laws of the coupling: molecular force to hand force, handle travel to molecule travel. SI.
#pragma once
#include <variant>

namespace palpa {

// Eq. 2 of the paper as printed: F_h = α1 atan(δ1 F) + α2 [atan(δ2 (F - F0)) + atan(δ2 (F + F0))].
// Odd in F to the last bit, monotone, tends to ±F_h2. Its slope at 0 is 8 % above A_fmax.
class PrintedForceLaw {
public:
    struct Parameters {
        double F_h1 = 1.0;       // N, where low forces tend to
        double F_h2 = 3.0;       // N, where high forces tend to; > F_h1
        double F_0 = 1.5e-9;     // N, between low and high molecular forces
        double A_fmin = 0.64e9;  // gain of high forces
        double A_fmax = 5.1e9;   // gain of low forces
    };

    explicit PrintedForceLaw(const Parameters& parameters) noexcept;

    double value(double F_m) const noexcept;  // N
    double slope(double F_m) const noexcept;  // dF_h/dF_m

private:
    double alpha_1_, alpha_2_;  // N
    double delta_1_, delta_2_;  // 1/N
    double F_0_;
};

// F_h = gain F_m; a gain of 0 is the mode without force.
struct ConstantForceLaw {
    double gain = 0;

    double value(double F_m) const noexcept { return gain * F_m; }
    double slope(double /*F_m*/) const noexcept { return gain; }
};

using ForceLaw = std::variant<PrintedForceLaw, ConstantForceLaw>;

// Force on the hand (N) for the molecular force F_m (N) along one direction, and its derivative.
double hand_force(const ForceLaw& law, double F_m) noexcept;
double hand_force_slope(const ForceLaw& law, double F_m) noexcept;
// F_h/F_m, the gain that is on at F_m; its limit, the slope, at F_m = 0.
double force_gain(const ForceLaw& law, double F_m) noexcept;

// Eq. 3 of the paper as printed: A_d = A_dmin + β [atan((|F| - F_off) γ) - atan(-F_off γ)], handle
// metres per molecule metre. A_d(0) is A_dmin to the last bit, the limit is A_dmax.
class PrintedDisplacementLaw {
public:
    struct Parameters {
        double gamma = 10e11;     // 1/N, how sharp the transition is
        double F_off = 20e-12;    // N, where it is
        double A_dmin = 0.005e9;  // far from everything
        double A_dmax = 0.25e9;   // in contact
    };

    explicit PrintedDisplacementLaw(const Parameters& parameters) noexcept;

    double value(double F_m) const noexcept;
    // dA_d/dF_m; the law has a kink at 0, where this is 0.
    double slope(double F_m) const noexcept;

private:
    double A_dmin_, beta_, gamma_, F_off_, atan_at_0_;
};

struct ConstantDisplacementLaw {
    double gain = 0.25e9;

    double value(double /*F_m*/) const noexcept { return gain; }
    double slope(double /*F_m*/) const noexcept { return 0; }
};

using DisplacementLaw = std::variant<PrintedDisplacementLaw, ConstantDisplacementLaw>;

// A_d, handle metres per molecule metre, where the molecular force is F_m (N).
double displacement_gain(const DisplacementLaw& law, double F_m) noexcept;

// Both sides of the paper's coupling.
struct CouplingLaws {
    ForceLaw force;
    DisplacementLaw displacement;
};

}  // namespace palpa
