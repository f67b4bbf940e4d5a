#include "forces/nonbonded.h"

#include "core/assertion.h"
#include "field/pair_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace palpa {
namespace {

// An energy that depends on a distance r alone, and -E'/r, what turns the vector between two atoms
// into a force.
struct Radial {
    double energy, gradient;
};

struct Pair {
    Radial van_der_waals, electrostatic;
};

Radial lennard_jones(double inverse_r2, const LennardJonesPair& pair) noexcept {
    const double s2 = pair.rmin * pair.rmin * inverse_r2;
    const double s6 = s2 * s2 * s2;
    const double depth = pair.epsilon * s6;
    return {depth * (s6 - 2.0), 12.0 * depth * (s6 - 1.0) * inverse_r2};
}

// A law gives the pair's energies at a squared distance; `charges` is C q q'/eps. Pairs from
// `reach2` on have none.

// The plain one, with a constant dielectric.
struct WholeLaw {
    static constexpr double reach2 = std::numeric_limits<double>::infinity();

    static Pair evaluate(double r2, double charges, const LennardJonesPair& pair) noexcept {
        const double inverse_r2 = 1.0 / r2;
        const double electrostatic = charges * std::sqrt(inverse_r2);
        return {lennard_jones(inverse_r2, pair), {electrostatic, electrostatic * inverse_r2}};
    }
};

// Any other settings.
class CutoffLaw {
public:
    explicit CutoffLaw(const NonbondedSettings& settings) noexcept
        : reach2(settings.electrostatics == ElectrostaticCutoff::None ||
                         settings.van_der_waals == VanDerWaalsCutoff::None
                     ? std::numeric_limits<double>::infinity()
                     : settings.cutoff * settings.cutoff),
          settings_(settings),
          c2_(settings.cutoff * settings.cutoff),
          m2_(settings.switch_from * settings.switch_from),
          width_((c2_ - m2_) * (c2_ - m2_) * (c2_ - m2_)) {
        // Below m the force-switched energy differs from the plain one by a constant.
        force_switch_offset_ = force_switch_energy(m2_) - bare(m2_).energy;
    }

    Pair evaluate(double r2, double charges, const LennardJonesPair& pair) const noexcept {
        const Radial unit = electrostatic(r2);
        return {van_der_waals(r2, pair), {charges * unit.energy, charges * unit.gradient}};
    }

    double reach2;  // Å^2

private:
    // Of unit charges, without a cutoff.
    Radial bare(double r2) const noexcept {
        const double inverse_r2 = 1.0 / r2;
        if (settings_.distance_dielectric) return {inverse_r2, 2.0 * inverse_r2 * inverse_r2};
        const double inverse_r = std::sqrt(inverse_r2);
        return {inverse_r, inverse_r * inverse_r2};
    }

    // S(r), and E S(r).
    double switching(double r2) const noexcept {
        if (r2 <= m2_) return 1.0;
        return (c2_ - r2) * (c2_ - r2) * (c2_ + 2.0 * r2 - 3.0 * m2_) / width_;
    }

    Radial switched(double r2, Radial whole) const noexcept {
        if (r2 <= m2_) return whole;
        const double slope = -12.0 * (c2_ - r2) * (r2 - m2_) / width_;  // S'/r
        const double S = switching(r2);
        return {whole.energy * S, whole.gradient * S - whole.energy * slope};
    }

    Radial electrostatic(double r2) const noexcept {
        if (settings_.electrostatics == ElectrostaticCutoff::None) return bare(r2);
        if (r2 >= c2_) return {0, 0};
        Radial unit = bare(r2);
        switch (settings_.electrostatics) {
            case ElectrostaticCutoff::None:
                break;
            case ElectrostaticCutoff::Switch:
                unit = switched(r2, unit);
                break;
            case ElectrostaticCutoff::Shift: {
                const double left = 1.0 - r2 / c2_;
                unit = {unit.energy * left * left,
                        unit.gradient * left * left + unit.energy * 4.0 * left / c2_};
                break;
            }
            case ElectrostaticCutoff::ForceShift: {
                const double left = 1.0 - std::sqrt(r2) / settings_.cutoff;
                unit = {unit.energy * left * left, unit.gradient - unit.energy / c2_};
                break;
            }
            case ElectrostaticCutoff::ForceSwitch:
                unit = {r2 <= m2_ ? unit.energy + force_switch_offset_ : force_switch_energy(r2),
                        unit.gradient * switching(r2)};
                break;
        }
        return unit;
    }

    // The integral from r to c of the unswitched force times S, which is a polynomial in r^2.
    double force_switch_energy(double r2) const noexcept {
        const double s0 = c2_ * c2_ * (c2_ - 3.0 * m2_) / width_;
        const double s2 = 6.0 * c2_ * m2_ / width_;
        const double s4 = -3.0 * (c2_ + m2_) / width_;
        const double s6 = 2.0 / width_;
        if (settings_.distance_dielectric) {  // force 2/r^3
            return s0 * (1.0 / r2 - 1.0 / c2_) + s2 * std::log(c2_ / r2) + s4 * (c2_ - r2) +
                   s6 / 2.0 * (c2_ * c2_ - r2 * r2);
        }
        const double r = std::sqrt(r2), c = settings_.cutoff;  // force 1/r^2
        return s0 * (1.0 / r - 1.0 / c) + s2 * (c - r) + s4 / 3.0 * (c * c2_ - r * r2) +
               s6 / 5.0 * (c * c2_ * c2_ - r * r2 * r2);
    }

    Radial van_der_waals(double r2, const LennardJonesPair& pair) const noexcept {
        const double inverse_r2 = 1.0 / r2;
        switch (settings_.van_der_waals) {
            case VanDerWaalsCutoff::None:
                return lennard_jones(inverse_r2, pair);
            case VanDerWaalsCutoff::Switch:
                if (r2 >= c2_) return {0, 0};
                return switched(r2, lennard_jones(inverse_r2, pair));
            case VanDerWaalsCutoff::ForceSwitch:
                break;
        }
        if (r2 >= c2_) return {0, 0};
        const double rmin2 = pair.rmin * pair.rmin, rmin6 = rmin2 * rmin2 * rmin2;
        const double a = pair.epsilon * rmin6 * rmin6, b = 2.0 * pair.epsilon * rmin6;
        const double c3 = c2_ * settings_.cutoff, m3 = m2_ * settings_.switch_from;
        if (r2 <= m2_) {
            Radial shifted = lennard_jones(inverse_r2, pair);
            shifted.energy += b / (c3 * m3) - a / (c3 * c3 * m3 * m3);
            return shifted;
        }
        const double inverse_r3 = inverse_r2 * std::sqrt(inverse_r2);
        const double left6 = inverse_r3 * inverse_r3 - 1.0 / (c3 * c3);
        const double left3 = inverse_r3 - 1.0 / c3;
        const double repulsion = a * c3 * c3 / (c3 * c3 - m3 * m3) * left6;
        const double attraction = b * c3 / (c3 - m3) * left3;
        return {repulsion * left6 - attraction * left3,
                (12.0 * repulsion * inverse_r3 - 6.0 * attraction) * inverse_r3 * inverse_r2};
    }

    NonbondedSettings settings_;
    double c2_, m2_;  // Å^2
    double width_;    // (c^2 - m^2)^3, Å^6
    double force_switch_offset_ = 0;
};

// Adds the pair's force, d from j to i, and its energy.
template <class Law>
void add_pair(const Law& law, const Vec3& d, double charges, const LennardJonesPair& parameters,
              NonbondedEnergy& energy, Vec3& on_i, Vec3& on_j) noexcept {
    constexpr double core2 = pair_core_radius * pair_core_radius;
    const double distance2 = d.squaredNorm();
    if (distance2 >= law.reach2) return;
    const Pair pair = law.evaluate(std::max(distance2, core2), charges, parameters);
    energy.van_der_waals += pair.van_der_waals.energy;
    energy.electrostatic += pair.electrostatic.energy;
    if (distance2 < core2) {
        const double below = 0.5 * (core2 - distance2);
        energy.van_der_waals += pair.van_der_waals.gradient * below;
        energy.electrostatic += pair.electrostatic.gradient * below;
    }
    const Vec3 force = (pair.van_der_waals.gradient + pair.electrostatic.gradient) * d;
    on_i += force;
    on_j -= force;
}

template <class Law>
NonbondedEnergy add_pairs(const Topology& topology, const Law& law, double coulomb,
                          std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    NonbondedEnergy total;
    const std::size_t n = topology.size();
    for (std::size_t i = 0; i < n; ++i) {
        const double charge = coulomb * topology.charge[i];
        const LennardJonesPair* const row = topology.lennard_jones.row(topology.type[i]);
        NonbondedEnergy energy;
        Vec3 force = Vec3::Zero();
        std::size_t j = i + 1;
        const auto add_up_to = [&](std::size_t end) {
            for (; j < end; ++j) {
                add_pair(law, positions[i] - positions[j], charge * topology.charge[j],
                         row[topology.type[j]], energy, force, forces[j]);
            }
        };
        for (const std::uint32_t excluded : topology.exclusions.of(i)) {
            add_up_to(excluded);
            ++j;
        }
        add_up_to(n);
        forces[i] += force;
        total.van_der_waals += energy.van_der_waals;
        total.electrostatic += energy.electrostatic;
    }
    return total;
}

template <class Law>
NonbondedEnergy add_pairs14(const Topology& topology, const Law& law, double coulomb,
                            std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    NonbondedEnergy energy;
    for (const auto& [i, j] : topology.exclusions.pairs14) {
        add_pair(law, positions[i] - positions[j],
                 coulomb * topology.charge[i] * topology.charge[j],
                 topology.lennard_jones14.row(topology.type[i])[topology.type[j]], energy,
                 forces[i], forces[j]);
    }
    return energy;
}

// Calls `sum` with the law that the settings ask for.
template <class Sum>
NonbondedEnergy with_law(const NonbondedSettings& settings, const Sum& sum) noexcept {
    PALPA_ASSERT(!find_problem(settings));
    const bool whole = settings.electrostatics == ElectrostaticCutoff::None &&
                       settings.van_der_waals == VanDerWaalsCutoff::None &&
                       !settings.distance_dielectric;
    return whole ? sum(WholeLaw{}) : sum(CutoffLaw(settings));
}

}  // namespace

std::optional<std::string_view> find_problem(const NonbondedSettings& settings) noexcept {
    if (!(settings.dielectric > 0)) return "the dielectric must be above 0";
    const bool switches = settings.electrostatics == ElectrostaticCutoff::Switch ||
                          settings.electrostatics == ElectrostaticCutoff::ForceSwitch ||
                          settings.van_der_waals != VanDerWaalsCutoff::None;
    const bool ends = switches || settings.electrostatics != ElectrostaticCutoff::None;
    if (ends && !(settings.cutoff > 0)) return "the cutoff must be above 0 Å";
    if (switches && !(settings.switch_from > 0 && settings.switch_from < settings.cutoff))
        return "switching must begin above 0 Å and before the cutoff";
    if (settings.distance_dielectric && settings.electrostatics == ElectrostaticCutoff::ForceShift)
        return "force shift needs a constant dielectric";
    return std::nullopt;
}

NonbondedEnergy add_nonbonded_forces(const Topology& topology, const NonbondedSettings& settings,
                                     std::span<const Vec3> positions,
                                     std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    const double coulomb = settings.coulomb_constant / settings.dielectric;
    return with_law(settings, [&](const auto& law) {
        return add_pairs(topology, law, coulomb, positions, forces);
    });
}

NonbondedEnergy add_nonbonded14_forces(const Topology& topology, const NonbondedSettings& settings,
                                       std::span<const Vec3> positions,
                                       std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    const double coulomb =
        settings.coulomb_constant / settings.dielectric * settings.coulomb14_factor;
    return with_law(settings, [&](const auto& law) {
        return add_pairs14(topology, law, coulomb, positions, forces);
    });
}

}  // namespace palpa
