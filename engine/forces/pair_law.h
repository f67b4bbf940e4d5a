// Energy and force of one pair of atoms, with or without a cutoff: the function inside every pair
// sum. Without branches or roots, so that compilers can vectorise it.
#pragma once
#include "charmm/topology.h"
#include "core/repeatable.h"
#include "forces/nonbonded.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpa {

// An energy that depends on a distance r alone, and -E'/r, what turns the vector between two atoms
// into a force.
struct Radial {
    double energy, gradient;
};

struct PairEnergies {
    Radial van_der_waals, electrostatic;
};

inline Radial lennard_jones(double inverse_r2, const LennardJonesPair& pair) noexcept {
    const double s2 = pair.rmin * pair.rmin * inverse_r2;
    const double s6 = s2 * s2 * s2;
    const double depth = pair.epsilon * s6;
    return {depth * (s6 - 2.0), 12.0 * depth * (s6 - 1.0) * inverse_r2};
}

// The functions of `ElectrostaticCutoff` and `VanDerWaalsCutoff`. What has a form of its own from m
// on is taken at t = max(r, m), where the forms meet.
template <ElectrostaticCutoff ElectrostaticEnd, VanDerWaalsCutoff VanDerWaalsEnd,
          bool DistanceDielectric>
class PairLaw {
public:
    // Whether the energy is 0 beyond the cutoff.
    static constexpr bool ends =
        ElectrostaticEnd != ElectrostaticCutoff::None && VanDerWaalsEnd != VanDerWaalsCutoff::None;

    explicit PairLaw(const NonbondedSettings& settings) noexcept
        : reach2(ends ? settings.cutoff * settings.cutoff
                      : std::numeric_limits<double>::infinity()),
          c_(settings.cutoff),
          c2_(c_ * c_),
          m_(settings.switch_from),
          m2_(m_ * m_),
          inverse_c2_(1.0 / c2_),
          inverse_width_(1.0 / ((c2_ - m2_) * (c2_ - m2_) * (c2_ - m2_))),
          inverse_range_(1.0 / (c2_ - m2_)) {}

    // At the square of a distance and its inverse root; `charges` is C q q'/eps.
    PairEnergies evaluate(double r2, double inverse_r, double charges,
                          const LennardJonesPair& pair) const noexcept {
        const Radial unit = electrostatic(r2, inverse_r);
        return {van_der_waals(r2, inverse_r, pair),
                {charges * unit.energy, charges * unit.gradient}};
    }

    double reach2;  // Å^2, from where on pairs have nothing

private:
    // For unit charges, without a cutoff.
    static Radial bare(double inverse_r) noexcept {
        const double inverse_r2 = inverse_r * inverse_r;
        if constexpr (DistanceDielectric) return {inverse_r2, 2.0 * inverse_r2 * inverse_r2};
        return {inverse_r, inverse_r * inverse_r2};
    }

    // S(r), with t2 = t^2.
    double switching(double t2) const noexcept {
        return (c2_ - t2) * (c2_ - t2) * (c2_ + 2.0 * t2 - 3.0 * m2_) * inverse_width_;
    }

    Radial switched(double r2, const Radial& whole) const noexcept {
        const double t2 = std::max(r2, m2_);
        const double slope = -12.0 * (c2_ - t2) * (t2 - m2_) * inverse_width_;  // S'/r
        const double S = switching(t2);
        return {whole.energy * S, whole.gradient * S - whole.energy * slope};
    }

    // By the switch whose second derivative is continuous.
    Radial smoothly_switched(double r2, const Radial& whole) const noexcept {
        const double y = std::max(0.0, (r2 - m2_) * inverse_range_);
        const double S = 1.0 - y * y * y * (10.0 - y * (15.0 - 6.0 * y));
        const double slope = -60.0 * inverse_range_ * y * y * (1.0 - y) * (1.0 - y);  // S'/r
        return {whole.energy * S, whole.gradient * S - whole.energy * slope};
    }

    Radial electrostatic(double r2, double inverse_r) const noexcept {
        const Radial unit = bare(inverse_r);
        if constexpr (ElectrostaticEnd == ElectrostaticCutoff::None) return unit;
        if constexpr (!ends) {
            if (r2 >= c2_) return {0, 0};
        }
        if constexpr (ElectrostaticEnd == ElectrostaticCutoff::Switch) {
            return switched(r2, unit);
        } else if constexpr (ElectrostaticEnd == ElectrostaticCutoff::Shift) {
            const double left = 1.0 - r2 * inverse_c2_;
            return {unit.energy * left * left,
                    unit.gradient * left * left + 4.0 * inverse_c2_ * unit.energy * left};
        } else if constexpr (ElectrostaticEnd == ElectrostaticCutoff::CubicShift) {
            const double left = 1.0 - r2 * inverse_c2_, left2 = left * left;
            return {unit.energy * left2 * left,
                    unit.gradient * left2 * left + 6.0 * inverse_c2_ * unit.energy * left2};
        } else if constexpr (ElectrostaticEnd == ElectrostaticCutoff::ForceShift) {
            const double left = 1.0 - r2 * inverse_r / c_;
            return {unit.energy * left * left, unit.gradient - unit.energy * inverse_c2_};
        } else {
            const double t2 = std::max(r2, m2_), inverse_t = std::min(inverse_r, 1.0 / m_);
            const double before_m = unit.energy - bare(inverse_t).energy;
            return {force_switch_energy(t2, inverse_t) + before_m, unit.gradient * switching(t2)};
        }
    }

    // The integral from r to c of the unswitched force times S, which is a polynomial in r^2.
    double force_switch_energy(double r2, double inverse_r) const noexcept {
        const double s0 = c2_ * c2_ * (c2_ - 3.0 * m2_) * inverse_width_;
        const double s2 = 6.0 * c2_ * m2_ * inverse_width_;
        const double s4 = -3.0 * (c2_ + m2_) * inverse_width_;
        const double s6 = 2.0 * inverse_width_;
        if constexpr (DistanceDielectric) {  // force 2/r^3
            return s0 * (inverse_r * inverse_r - inverse_c2_) + s2 * repeatable::log(c2_ / r2) +
                   s4 * (c2_ - r2) + s6 / 2.0 * (c2_ * c2_ - r2 * r2);
        }
        const double r = r2 * inverse_r;  // force 1/r^2
        return s0 * (inverse_r - 1.0 / c_) + s2 * (c_ - r) + s4 / 3.0 * (c_ * c2_ - r * r2) +
               s6 / 5.0 * (c_ * c2_ * c2_ - r * r2 * r2);
    }

    Radial van_der_waals(double r2, double inverse_r, const LennardJonesPair& pair) const noexcept {
        const Radial whole = lennard_jones(inverse_r * inverse_r, pair);
        if constexpr (VanDerWaalsEnd == VanDerWaalsCutoff::None) return whole;
        if constexpr (!ends) {
            if (r2 >= c2_) return {0, 0};
        }
        if constexpr (VanDerWaalsEnd == VanDerWaalsCutoff::Switch) {
            return switched(r2, whole);
        } else if constexpr (VanDerWaalsEnd == VanDerWaalsCutoff::SmoothSwitch) {
            return smoothly_switched(r2, whole);
        } else {
            const double inverse_t = std::min(inverse_r, 1.0 / m_);
            const Radial at_t = lennard_jones(inverse_t * inverse_t, pair);
            const Radial end = force_switched(inverse_t, pair);
            return {end.energy + (whole.energy - at_t.energy),
                    end.gradient + (whole.gradient - at_t.gradient)};
        }
    }

    // Lennard-Jones from m on, its force switched.
    Radial force_switched(double inverse_r, const LennardJonesPair& pair) const noexcept {
        const double rmin2 = pair.rmin * pair.rmin, rmin6 = rmin2 * rmin2 * rmin2;
        const double a = pair.epsilon * rmin6 * rmin6, b = 2.0 * pair.epsilon * rmin6;
        const double c3 = c_ * c2_, m3 = m_ * m2_;
        const double inverse_r2 = inverse_r * inverse_r, inverse_r3 = inverse_r2 * inverse_r;
        const double left6 = inverse_r3 * inverse_r3 - 1.0 / (c3 * c3);
        const double left3 = inverse_r3 - 1.0 / c3;
        const double repulsion = c3 * c3 / (c3 * c3 - m3 * m3) * a * left6;
        const double attraction = c3 / (c3 - m3) * b * left3;
        return {repulsion * left6 - attraction * left3,
                (12.0 * repulsion * inverse_r3 - 6.0 * attraction) * inverse_r3 * inverse_r2};
    }

    double c_, c2_, m_, m2_;  // Å, Å^2
    double inverse_c2_;       // Å^-2
    double inverse_width_;    // 1/(c^2 - m^2)^3, Å^-6
    double inverse_range_;    // 1/(c^2 - m^2), Å^-2
};

// Calls `sum` with the law for these settings.
template <ElectrostaticCutoff ElectrostaticEnd, VanDerWaalsCutoff VanDerWaalsEnd, class Sum>
auto with_dielectric(const NonbondedSettings& settings, const Sum& sum) noexcept {
    if (settings.distance_dielectric)
        return sum(PairLaw<ElectrostaticEnd, VanDerWaalsEnd, true>(settings));
    return sum(PairLaw<ElectrostaticEnd, VanDerWaalsEnd, false>(settings));
}

template <ElectrostaticCutoff ElectrostaticEnd, class Sum>
auto with_van_der_waals(const NonbondedSettings& settings, const Sum& sum) noexcept {
    using enum VanDerWaalsCutoff;
    switch (settings.van_der_waals) {
        case Switch:
            return with_dielectric<ElectrostaticEnd, Switch>(settings, sum);
        case ForceSwitch:
            return with_dielectric<ElectrostaticEnd, ForceSwitch>(settings, sum);
        case SmoothSwitch:
            return with_dielectric<ElectrostaticEnd, SmoothSwitch>(settings, sum);
        case None:
            break;
    }
    return with_dielectric<ElectrostaticEnd, None>(settings, sum);
}

template <class Sum>
auto with_law(const NonbondedSettings& settings, const Sum& sum) noexcept {
    using enum ElectrostaticCutoff;
    switch (settings.electrostatics) {
        case Switch:
            return with_van_der_waals<Switch>(settings, sum);
        case Shift:
            return with_van_der_waals<Shift>(settings, sum);
        case ForceShift:
            return with_van_der_waals<ForceShift>(settings, sum);
        case ForceSwitch:
            return with_van_der_waals<ForceSwitch>(settings, sum);
        case CubicShift:
            return with_van_der_waals<CubicShift>(settings, sum);
        case None:
            break;
    }
    return with_van_der_waals<None>(settings, sum);
}

}  // namespace palpa
