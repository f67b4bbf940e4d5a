#include "field/pair_field.h"

#include "core/assertion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

constexpr double core2 = pair_core_radius * pair_core_radius;

// Energies of a pair and the two factors that force and stiffness are made of, d from j to i:
//   F_i = gradient d,   -dF_i/dd = -gradient 1 + curvature d d^T
struct Pair {
    double van_der_waals, electrostatic, gradient, curvature;
};

Pair evaluate_pair(double distance2, double charges, double epsilon, double rmin) noexcept {
    // Below the core radius the pair is taken at the core and continued as a parabola in d.
    const double r2 = std::max(distance2, core2);
    const double inverse_r2 = 1.0 / r2;
    const double s2 = rmin * rmin * inverse_r2;
    const double s6 = s2 * s2 * s2;
    const double electrostatic = charges * std::sqrt(inverse_r2);
    const double van_der_waals = epsilon * s6 * (s6 - 2.0);

    // -U'/r and (U'' - U'/r)/r^2, term by term.
    const double gradient_lj = 12.0 * epsilon * s6 * (s6 - 1.0) * inverse_r2;
    const double gradient_coulomb = electrostatic * inverse_r2;
    if (distance2 < core2) {
        const double below = 0.5 * (core2 - distance2);
        return {van_der_waals + gradient_lj * below, electrostatic + gradient_coulomb * below,
                gradient_lj + gradient_coulomb, 0.0};
    }
    const double curvature =
        (epsilon * s6 * (168.0 * s6 - 96.0) + 3.0 * electrostatic) * inverse_r2 * inverse_r2;
    return {van_der_waals, electrostatic, gradient_lj + gradient_coulomb, curvature};
}

template <class Visit>
FieldSum sum_pairs(const FieldPoints& group, const FieldPoints& environment,
                   double coulomb_constant, const Visit& visit) noexcept {
    FieldSum sum;
    for (std::size_t i = 0; i < group.positions.size(); ++i) {
        const double charge = coulomb_constant * group.charge[i];
        for (std::size_t j = 0; j < environment.positions.size(); ++j) {
            const Vec3 d = group.positions[i] - environment.positions[j];
            const Pair pair = evaluate_pair(d.squaredNorm(), charge * environment.charge[j],
                                            group.sqrt_epsilon[i] * environment.sqrt_epsilon[j],
                                            group.half_rmin[i] + environment.half_rmin[j]);
            const Vec3 force = pair.gradient * d;
            sum.van_der_waals += pair.van_der_waals;
            sum.electrostatic += pair.electrostatic;
            sum.force += force;
            sum.stiffness += pair.curvature * d * d.transpose();
            sum.stiffness.diagonal().array() -= pair.gradient;
            visit(i, j, force);
        }
    }
    return sum;
}

}  // namespace

FieldSum evaluate_pair_field(const FieldPoints& group, const FieldPoints& environment,
                             double coulomb_constant) noexcept {
    return sum_pairs(group, environment, coulomb_constant,
                     [](std::size_t, std::size_t, const Vec3&) {});
}

FieldSum add_pair_forces(const FieldPoints& group, const FieldPoints& environment,
                         double coulomb_constant, std::span<Vec3> group_forces,
                         std::span<Vec3> environment_forces) noexcept {
    PALPA_ASSERT(group_forces.size() == group.positions.size());
    PALPA_ASSERT(environment_forces.size() == environment.positions.size());
    return sum_pairs(group, environment, coulomb_constant,
                     [&](std::size_t i, std::size_t j, const Vec3& force) {
                         group_forces[i] += force;
                         environment_forces[j] -= force;
                     });
}

}  // namespace palpa
