#include "field/pair_field.h"

#include "core/assertion.h"

#include <algorithm>
#include <cstddef>

namespace palpa {
namespace {

constexpr double core2 = pair_core_radius * pair_core_radius;

// Four pairs beside each other, as processors like it.
constexpr std::size_t lane_count = 4;
using Lanes = Eigen::Array<double, lane_count, 1>;

// A piece of the environment, copied so that lanes stand together. What fills the last lanes up
// has no charge and no well, and is far away.
struct Block {
    static constexpr std::size_t most = 128;

    std::size_t lanes = 0;  // groups of four
    Lanes x[most / lane_count], y[most / lane_count], z[most / lane_count];
    Lanes charge[most / lane_count], sqrt_epsilon[most / lane_count], half_rmin[most / lane_count];
};

void fill_block(const FieldPoints& points, std::size_t first, std::size_t count,
                Block& block) noexcept {
    constexpr double far = 1e6;
    block.lanes = (count + lane_count - 1) / lane_count;
    for (std::size_t j = 0; j < block.lanes * lane_count; ++j) {
        const std::size_t group = j / lane_count;
        const auto lane = static_cast<Eigen::Index>(j % lane_count);
        const bool there = j < count;
        block.x[group](lane) = there ? points.positions[first + j].x() : far;
        block.y[group](lane) = there ? points.positions[first + j].y() : far;
        block.z[group](lane) = there ? points.positions[first + j].z() : far;
        block.charge[group](lane) = there ? points.charge[first + j] : 0;
        block.sqrt_epsilon[group](lane) = there ? points.sqrt_epsilon[first + j] : 0;
        block.half_rmin[group](lane) = there ? points.half_rmin[first + j] : 0;
    }
}

// Energies of pairs and the two factors that force and stiffness are made of, d from j to i:
//   F_i = gradient d,   -dF_i/dd = -gradient 1 + curvature d d^T
struct Pairs {
    Lanes van_der_waals, electrostatic, gradient, curvature;
};

[[gnu::always_inline]] inline Pairs evaluate_pairs(const Lanes& distance2, const Lanes& charges,
                                                   const Lanes& epsilon,
                                                   const Lanes& rmin) noexcept {
    // Below the core radius a pair is taken at the core and continued as a parabola in d.
    const Lanes r2 = distance2.max(core2);
    const Lanes inverse_r2 = r2.inverse();
    const Lanes s2 = rmin * rmin * inverse_r2;
    const Lanes s6 = s2 * s2 * s2;
    const Lanes well = epsilon * s6;
    const Lanes electrostatic = charges * inverse_r2.sqrt();

    // -U'/r and (U'' - U'/r)/r^2, term by term.
    const Lanes gradient_lj = 12.0 * well * (s6 - 1.0) * inverse_r2;
    const Lanes gradient_coulomb = electrostatic * inverse_r2;
    const Lanes curvature =
        (well * (168.0 * s6 - 96.0) + 3.0 * electrostatic) * inverse_r2 * inverse_r2;
    const Lanes below = (0.5 * (core2 - distance2)).max(0.0);
    return {well * (s6 - 2.0) + gradient_lj * below, electrostatic + gradient_coulomb * below,
            gradient_lj + gradient_coulomb, (distance2 < core2).select(0.0, curvature)};
}

// Puts the numbers of replaced pairs in place: one type with each of up to four neighbours.
void replace_pairs(std::span<const ReplacedPair> replaced, std::uint32_t type,
                   std::span<const std::uint32_t> types, Lanes& epsilon, Lanes& rmin) noexcept {
    for (std::size_t lane = 0; lane < types.size(); ++lane) {
        for (const ReplacedPair& pair : replaced) {
            if ((pair.a != type || pair.b != types[lane]) &&
                (pair.b != type || pair.a != types[lane])) {
                continue;
            }
            epsilon(static_cast<Eigen::Index>(lane)) = pair.epsilon;
            rmin(static_cast<Eigen::Index>(lane)) = pair.rmin;
        }
    }
}

bool is_replaced(std::span<const ReplacedPair> replaced, std::uint32_t type) noexcept {
    return std::any_of(replaced.begin(), replaced.end(), [type](const ReplacedPair& pair) {
        return pair.a == type || pair.b == type;
    });
}

// Calls visit(i, j, force on i) for every pair.
template <class Visit>
FieldSum sum_pairs(const FieldPoints& group, const FieldPoints& environment, const PairRule& rule,
                   const Visit& visit) noexcept {
    FieldSum sum;
    Block block;
    for (std::size_t first = 0; first < environment.positions.size(); first += Block::most) {
        const std::size_t count = std::min(Block::most, environment.positions.size() - first);
        fill_block(environment, first, count, block);
        for (std::size_t i = 0; i < group.positions.size(); ++i) {
            const Vec3 place = group.positions[i];
            const double charge = rule.coulomb_constant * group.charge[i];
            const bool replaced =
                !rule.replaced.empty() && is_replaced(rule.replaced, group.type[i]);
            Lanes van_der_waals = Lanes::Zero(), electrostatic = Lanes::Zero();
            Lanes fx = Lanes::Zero(), fy = Lanes::Zero(), fz = Lanes::Zero();
            Lanes kxx = Lanes::Zero(), kyy = Lanes::Zero(), kzz = Lanes::Zero();
            Lanes kxy = Lanes::Zero(), kxz = Lanes::Zero(), kyz = Lanes::Zero();
            Lanes gradients = Lanes::Zero();
            for (std::size_t l = 0; l < block.lanes; ++l) {
                const Lanes dx = place.x() - block.x[l];
                const Lanes dy = place.y() - block.y[l];
                const Lanes dz = place.z() - block.z[l];
                Lanes epsilon = group.sqrt_epsilon[i] * block.sqrt_epsilon[l];
                Lanes rmin = group.half_rmin[i] + block.half_rmin[l];
                if (replaced) {
                    const std::size_t at = l * lane_count;
                    replace_pairs(
                        rule.replaced, group.type[i],
                        environment.type.subspan(first + at, std::min(lane_count, count - at)),
                        epsilon, rmin);
                }
                const Pairs pairs = evaluate_pairs(dx * dx + dy * dy + dz * dz,
                                                   charge * block.charge[l], epsilon, rmin);
                const Lanes px = pairs.gradient * dx;
                const Lanes py = pairs.gradient * dy;
                const Lanes pz = pairs.gradient * dz;
                const Lanes cx = pairs.curvature * dx;
                const Lanes cy = pairs.curvature * dy;
                van_der_waals += pairs.van_der_waals;
                electrostatic += pairs.electrostatic;
                fx += px;
                fy += py;
                fz += pz;
                kxx += cx * dx;
                kxy += cx * dy;
                kxz += cx * dz;
                kyy += cy * dy;
                kyz += cy * dz;
                kzz += pairs.curvature * dz * dz;
                gradients += pairs.gradient;
                visit(i, first + l * lane_count, std::min(lane_count, count - l * lane_count), px,
                      py, pz);
            }
            const Vec3 force(fx.sum(), fy.sum(), fz.sum());
            sum.van_der_waals += van_der_waals.sum();
            sum.electrostatic += electrostatic.sum();
            sum.force += force;
            sum.torque += place.cross(force);
            const double xy = kxy.sum(), xz = kxz.sum(), yz = kyz.sum();
            sum.stiffness +=
                (Mat3() << kxx.sum(), xy, xz, xy, kyy.sum(), yz, xz, yz, kzz.sum()).finished();
            sum.stiffness.diagonal().array() -= gradients.sum();
        }
    }
    return sum;
}

}  // namespace

FieldSum evaluate_pair_field(const FieldPoints& group, const FieldPoints& environment,
                             const PairRule& rule) noexcept {
    return sum_pairs(group, environment, rule, [](auto&&...) {});
}

FieldSum add_pair_forces(const FieldPoints& group, const FieldPoints& environment,
                         const PairRule& rule, std::span<Vec3> group_forces,
                         std::span<Vec3> environment_forces) noexcept {
    PALPA_ASSERT(group_forces.size() == group.positions.size());
    PALPA_ASSERT(environment_forces.size() == environment.positions.size());
    return sum_pairs(group, environment, rule,
                     [&](std::size_t i, std::size_t j, std::size_t count, const Lanes& x,
                         const Lanes& y, const Lanes& z) {
                         for (std::size_t lane = 0; lane < count; ++lane) {
                             const auto l = static_cast<Eigen::Index>(lane);
                             const Vec3 force(x(l), y(l), z(l));
                             group_forces[i] += force;
                             environment_forces[j + lane] -= force;
                         }
                     });
}

}  // namespace palpa
