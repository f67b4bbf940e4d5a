#include "forces/pair_hessian.h"

#include "core/assertion.h"
#include "field/pair_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpa {
namespace {

// A function of u = r^2/2 and its first two derivatives.
struct Jet {
    double value, first, second;

    PairHessian hessian() const noexcept { return {first, second}; }
};

Jet operator+(const Jet& a, const Jet& b) noexcept {
    return {a.value + b.value, a.first + b.first, a.second + b.second};
}

Jet operator*(double factor, const Jet& a) noexcept {
    return {factor * a.value, factor * a.first, factor * a.second};
}

Jet operator*(const Jet& a, const Jet& b) noexcept {
    return {a.value * b.value, a.first * b.value + a.value * b.first,
            a.second * b.value + 2 * a.first * b.first + a.value * b.second};
}

Jet constant(double value) noexcept { return {value, 0, 0}; }

double integer_power(double x, int n) noexcept {
    double result = 1;
    for (int i = 0; i < n; ++i) result *= x;
    return result;
}

// r^n
Jet power(int n, double r2) noexcept {
    const double inverse_r2 = 1 / r2;
    const double even = n < 0 ? integer_power(inverse_r2, -n / 2) : integer_power(r2, n / 2);
    const double value = n % 2 == 0 ? even
                         : n < 0    ? even * std::sqrt(inverse_r2)
                                    : even * std::sqrt(r2);
    return {value, n * value * inverse_r2, n * (n - 2) * value * inverse_r2 * inverse_r2};
}

Jet lennard_jones_jet(double r2, const LennardJonesPair& pair) noexcept {
    const double rmin6 = integer_power(pair.rmin, 6);
    return pair.epsilon * rmin6 * (rmin6 * power(-12, r2) + -2.0 * power(-6, r2));
}

// S(r) of field/cutoff.h: 1 before m, 0 from c on.
Jet switching_jet(double r2, double m2, double c2) noexcept {
    if (r2 <= m2) return constant(1);
    const double width3 = integer_power(c2 - m2, 3);
    return {(c2 - r2) * (c2 - r2) * (c2 + 2 * r2 - 3 * m2) / width3,
            -12 * (c2 - r2) * (r2 - m2) / width3, -24 * (c2 + m2 - 2 * r2) / width3};
}

// The one that is smooth to the second derivative.
Jet smooth_switching_jet(double r2, double m2, double c2) noexcept {
    if (r2 <= m2) return constant(1);
    const double range = c2 - m2, y = (r2 - m2) / range, left = 1 - y, slope = 2 / range;
    return {1 - y * y * y * (10 - y * (15 - 6 * y)), -30 * y * y * left * left * slope,
            -60 * y * left * (1 - 2 * y) * slope * slope};
}

// Of an energy whose force is that of `whole` times S.
PairHessian with_switched_force(const Jet& whole, const Jet& S) noexcept {
    return {whole.first * S.value, whole.second * S.value + whole.first * S.first};
}

}  // namespace

PairHessianLaw::PairHessianLaw(const NonbondedSettings& settings) noexcept
    : electrostatics_(settings.electrostatics),
      van_der_waals_(settings.van_der_waals),
      distance_dielectric_(settings.distance_dielectric),
      reach2_(has_end(settings) ? settings.cutoff * settings.cutoff
                                : std::numeric_limits<double>::infinity()),
      c_(settings.cutoff),
      c2_(settings.cutoff * settings.cutoff),
      m2_(settings.switch_from * settings.switch_from) {}

PairHessian PairHessianLaw::electrostatic(double r2) const noexcept {
    const Jet whole = power(distance_dielectric_ ? -2 : -1, r2);
    if (electrostatics_ == ElectrostaticCutoff::None) return whole.hessian();
    if (r2 >= c2_) return {};
    switch (electrostatics_) {
        case ElectrostaticCutoff::Switch:
            return (whole * switching_jet(r2, m2_, c2_)).hessian();
        case ElectrostaticCutoff::Shift: {
            const Jet left = constant(1) + (-1 / c2_) * power(2, r2);
            return (whole * left * left).hessian();
        }
        case ElectrostaticCutoff::ForceShift: {
            const Jet left = constant(1) + (-1 / c_) * power(1, r2);
            return (whole * left * left).hessian();
        }
        case ElectrostaticCutoff::CubicShift: {
            const Jet left = constant(1) + (-1 / c2_) * power(2, r2);
            return (whole * left * left * left).hessian();
        }
        case ElectrostaticCutoff::ForceSwitch:
        case ElectrostaticCutoff::None:
            break;
    }
    return with_switched_force(whole, switching_jet(r2, m2_, c2_));
}

PairHessian PairHessianLaw::van_der_waals(double r2, const LennardJonesPair& pair) const noexcept {
    if (van_der_waals_ == VanDerWaalsCutoff::None) return lennard_jones_jet(r2, pair).hessian();
    if (r2 >= c2_) return {};
    if (van_der_waals_ == VanDerWaalsCutoff::Switch)
        return (lennard_jones_jet(r2, pair) * switching_jet(r2, m2_, c2_)).hessian();
    if (van_der_waals_ == VanDerWaalsCutoff::SmoothSwitch)
        return (lennard_jones_jet(r2, pair) * smooth_switching_jet(r2, m2_, c2_)).hessian();
    if (r2 <= m2_) return lennard_jones_jet(r2, pair).hessian();
    const double rmin6 = integer_power(pair.rmin, 6);
    const double a = pair.epsilon * rmin6 * rmin6, b = 2 * pair.epsilon * rmin6;
    const double c3 = c_ * c2_, m3 = m2_ * std::sqrt(m2_);
    const Jet left6 = power(-6, r2) + constant(-1 / (c3 * c3));
    const Jet left3 = power(-3, r2) + constant(-1 / c3);
    return (a * c3 * c3 / (c3 * c3 - m3 * m3) * (left6 * left6) +
            -b * c3 / (c3 - m3) * (left3 * left3))
        .hessian();
}

PairHessian PairHessianLaw::evaluate(double r2, double charges,
                                     const LennardJonesPair& pair) const noexcept {
    if (r2 >= reach2_) return {};
    constexpr double core2 = pair_core_radius * pair_core_radius;
    const double outside2 = std::max(r2, core2);
    PairHessian sum = electrostatic(outside2);
    sum.first *= charges;
    sum.second *= charges;
    if (pair.epsilon > 0) sum += van_der_waals(outside2, pair);
    if (r2 < core2) sum.second = 0;
    return sum;
}

TopologyPairHessian::TopologyPairHessian(const Topology& topology,
                                         const NonbondedSettings& settings) noexcept
    : topology_(topology),
      law_(settings),
      solvation_(settings.solvation),
      coulomb_(settings.coulomb_constant / settings.dielectric),
      coulomb14_(coulomb_ * settings.coulomb14_factor),
      reach2_(std::max(law_.reach2(), solvation_.reach2)) {
    PALPA_ASSERT(settings.solvation == SolvationEnd::None || topology.solvation);
}

PairHessian TopologyPairHessian::evaluate(const LennardJonesTable& lennard_jones, double coulomb,
                                          std::uint32_t i, std::uint32_t j,
                                          double r2) const noexcept {
    PairHessian sum = law_.evaluate(r2, coulomb * topology_.charge[i] * topology_.charge[j],
                                    lennard_jones.row(topology_.type[i])[topology_.type[j]]);
    if (r2 < solvation_.reach2) sum += solvation(i, j, r2);
    return sum;
}

PairHessian TopologyPairHessian::solvation(std::uint32_t i, std::uint32_t j,
                                           double r2) const noexcept {
    if (r2 >= solvation_.reach2) return {};
    const Solvation& numbers = *topology_.solvation;
    const SolvationPair pair =
        solvation_.evaluate(r2, solvation_atom(numbers, i), solvation_atom(numbers, j));
    return {pair.first, pair.second};
}

}  // namespace palpa
