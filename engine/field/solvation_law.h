// Energy of one pair of atoms by EEF1, and its first two derivatives: how much of each atom's water
// the other one's volume takes. What every sum of solvation in double is made of.
#pragma once
#include "core/repeatable.h"
#include "field/cutoff.h"
#include "field/pair_field.h"

#include <algorithm>
#include <cmath>

namespace palpa {

inline constexpr double sharp_solvation_end = 9;  // Å
// Where the smooth end begins, and from where on there is nothing, Å.
inline constexpr double smooth_solvation_begin = 8.5, smooth_solvation_end = 9.5;

// What one atom loses to another at r: -on_other V_other g, g = exp(-x^2)/r^2, x = (r - R)/lambda.
struct SolvationAtom {
    double volume = 0;          // Å^3
    double strength = 0;        // dG_free/(2 pi^(3/2) lambda), kcal/mol/Å
    double inverse_lambda = 0;  // 1/Å
    double radius = 0;          // R, Å

    // Whether pairs with it may have anything.
    bool counts() const noexcept { return volume != 0 || strength != 0; }
};

// An energy that depends on a distance r alone, by u = r^2/2: dE/du is what turns the vector
// between two atoms into minus a force.
struct SolvationPair {
    double energy_a = 0, energy_b = 0;  // kcal/mol, of each atom: together that of the pair
    double first = 0;                   // dE/du, kcal/mol/Å^2
    double second = 0;                  // d2E/du2, kcal/mol/Å^4
};

struct TrueExponential {
    double operator()(double x) const noexcept { return repeatable::exp(-x * x); }
};

// `exp_of_minus_square` is for those who compare with a program that has a table of it.
template <class Exponential = TrueExponential>
class SolvationLaw {
public:
    explicit SolvationLaw(SolvationEnd end, Exponential exp_of_minus_square = {}) noexcept
        : reach2(end == SolvationEnd::None    ? 0
                 : end == SolvationEnd::Sharp ? sharp_solvation_end * sharp_solvation_end
                                              : smooth_solvation_end * smooth_solvation_end),
          end_(end),
          exp_of_minus_square_(exp_of_minus_square) {}

    // At the square of a distance, Å^2. Within `pair_core_radius` the energy is linear in u, so
    // that it is finite, without a force, where the atoms are at one place.
    SolvationPair evaluate(double distance2, const SolvationAtom& a,
                           const SolvationAtom& b) const noexcept {
        if (distance2 >= reach2) return {};
        constexpr double core2 = pair_core_radius * pair_core_radius;
        const double r = std::sqrt(std::max(distance2, core2));
        const Along S = end_at(r), of_a = lost(a, b.volume, r), of_b = lost(b, a.volume, r);
        const Slopes on_a = slopes(of_a, S, r), on_b = slopes(of_b, S, r);
        SolvationPair pair{of_a.value * S.value, of_b.value * S.value, on_a.first + on_b.first,
                           on_a.second + on_b.second};
        if (distance2 < core2) {
            const double below = 0.5 * (distance2 - core2);
            pair.energy_a += on_a.first * below;
            pair.energy_b += on_b.first * below;
            pair.second = 0;
        }
        return pair;
    }

    double reach2;  // Å^2, from where on pairs have nothing

private:
    // A function of r, and its derivatives by it.
    struct Along {
        double value, first, second;
    };
    struct Slopes {
        double first, second;
    };

    Along lost(const SolvationAtom& atom, double volume, double r) const noexcept {
        if (atom.strength == 0 || volume == 0) return {0, 0, 0};
        const double x = (r - atom.radius) * atom.inverse_lambda, inverse_r = 1 / r;
        const double energy =
            -atom.strength * volume * exp_of_minus_square_(x) * inverse_r * inverse_r;
        const double u = 2 * (x * atom.inverse_lambda + inverse_r);
        return {
            energy, -u * energy,
            (u * u - 2 * atom.inverse_lambda * atom.inverse_lambda + 2 * inverse_r * inverse_r) *
                energy};
    }

    // What the energy is multiplied by.
    Along end_at(double r) const noexcept {
        if (end_ != SolvationEnd::Smooth || r <= smooth_solvation_begin) return {1, 0, 0};
        const double t = (r - smooth_solvation_begin) /
                         (smooth_solvation_end - smooth_solvation_begin),
                     left = 1 - t;
        return {1 - t * t * t * (10 - t * (15 - 6 * t)), -30 * t * t * left * left,
                -60 * t * left * (1 - 2 * t)};
    }

    // Of the product, by u.
    static Slopes slopes(const Along& energy, const Along& S, double r) noexcept {
        const double first = energy.first * S.value + energy.value * S.first;
        const double second =
            energy.second * S.value + 2 * energy.first * S.first + energy.value * S.second;
        return {first / r, (second - first / r) / (r * r)};
    }

    SolvationEnd end_;
    Exponential exp_of_minus_square_;
};

}  // namespace palpa
