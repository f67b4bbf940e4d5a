#include "field/pair_field.h"

#include "core/assertion.h"
#include "field/solvation_law.h"

#include <algorithm>
#include <cmath>
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

// The last one counts.
const ReplacedPair* find_pair(std::span<const ReplacedPair> replaced, std::uint32_t a,
                              std::uint32_t b) noexcept {
    const auto found =
        std::find_if(replaced.rbegin(), replaced.rend(), [&](const ReplacedPair& pair) {
            return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
        });
    return found == replaced.rend() ? nullptr : &*found;
}

bool is_replaced(std::span<const ReplacedPair> replaced, std::uint32_t type) noexcept {
    return std::any_of(replaced.begin(), replaced.end(), [type](const ReplacedPair& pair) {
        return pair.a == type || pair.b == type;
    });
}

// A function of u = r^2/2, and its derivatives by it.
struct Along {
    double value = 0, first = 0, second = 0;
};

Along operator*(const Along& a, const Along& b) noexcept {
    return {a.value * b.value, a.first * b.value + a.value * b.first,
            a.second * b.value + 2 * a.first * b.first + a.value * b.second};
}

// What smooth ends make of a pair: three energies, and derivatives of their sum by u.
struct SmoothPair {
    double van_der_waals = 0, electrostatic = 0, solvation = 0, first = 0, second = 0;
};

class SmoothPairLaw {
public:
    explicit SmoothPairLaw(const SmoothEnds& ends) noexcept
        : c2_(ends.cutoff * ends.cutoff),
          m2_(ends.switch_from * ends.switch_from),
          solvation_(ends.solvation) {}

    SmoothPair evaluate(double distance2, double charges, double epsilon, double rmin,
                        const SolvationAtom& a, const SolvationAtom& b) const noexcept {
        SmoothPair pair;
        if (distance2 < c2_) {
            const double s = std::max(distance2, core2), below = 0.5 * (distance2 - s);
            const Along coulomb = electrostatic(s, charges);
            const Along lj = van_der_waals(s, epsilon, rmin);
            pair = {lj.value + lj.first * below, coulomb.value + coulomb.first * below, 0,
                    lj.first + coulomb.first, below < 0 ? 0 : lj.second + coulomb.second};
        }
        const SolvationPair water = solvation_.evaluate(distance2, a, b);
        pair.solvation = water.energy_a + water.energy_b;
        pair.first += water.first;
        pair.second += water.second;
        return pair;
    }

private:
    Along electrostatic(double s, double charges) const noexcept {
        const double q = s / c2_, left = 1 - q;
        return {charges * left * left * left / s,
                -2 * charges * left * left * (1 + 2 * q) / (s * s),
                8 * charges * (1 - q * q * q) / (s * s * s)};
    }

    Along van_der_waals(double s, double epsilon, double rmin) const noexcept {
        const double s2 = rmin * rmin / s, s6 = s2 * s2 * s2, well = epsilon * s6;
        const Along whole{well * (s6 - 2), -12 * well * (s6 - 1) / s,
                          well * (168 * s6 - 96) / (s * s)};
        if (s <= m2_) return whole;
        const double slope = 2 / (c2_ - m2_), y = (s - m2_) / (c2_ - m2_), left = 1 - y;
        return whole * Along{1 - y * y * y * (10 - y * (15 - 6 * y)),
                             -30 * y * y * left * left * slope,
                             -60 * y * left * (1 - 2 * y) * slope * slope};
    }

    double c2_, m2_;  // Å^2
    SolvationLaw<> solvation_;
};

SolvationAtom solvation_of(const FieldPoints& points, std::size_t i) noexcept {
    const SolvationParameters& numbers = points.solvation;
    if (numbers.volume.empty()) return {};
    return {numbers.volume[i], numbers.strength[i], numbers.inverse_lambda[i], numbers.radius[i]};
}

// Calls visit(i, j, force on i) for every pair within reach.
template <class Visit>
FieldSum sum_smooth_pairs(const FieldPoints& group, const FieldPoints& environment,
                          const PairRule& rule, const Visit& visit) noexcept {
    const SmoothPairLaw law(*rule.smooth);
    const double reach = rule.smooth->reach();
    FieldSum sum;
    for (std::size_t i = 0; i < group.positions.size(); ++i) {
        const Vec3 place = group.positions[i];
        const SolvationAtom own = solvation_of(group, i);
        const bool replaced = !rule.replaced.empty() && is_replaced(rule.replaced, group.type[i]);
        Vec3 force = Vec3::Zero();
        for (std::size_t j = 0; j < environment.positions.size(); ++j) {
            const Vec3 d = place - environment.positions[j];
            const double distance2 = d.squaredNorm();
            if (distance2 >= reach * reach) continue;
            double epsilon = group.sqrt_epsilon[i] * environment.sqrt_epsilon[j];
            double rmin = group.half_rmin[i] + environment.half_rmin[j];
            if (replaced) {
                const ReplacedPair* const pair =
                    find_pair(rule.replaced, group.type[i], environment.type[j]);
                if (pair != nullptr) {
                    epsilon = pair->epsilon;
                    rmin = pair->rmin;
                }
            }
            const SmoothPair pair = law.evaluate(
                distance2, rule.coulomb_constant * group.charge[i] * environment.charge[j], epsilon,
                rmin, own, solvation_of(environment, j));
            sum.van_der_waals += pair.van_der_waals;
            sum.electrostatic += pair.electrostatic;
            sum.solvation += pair.solvation;
            const Vec3 pull = -pair.first * d;
            force += pull;
            sum.stiffness += pair.second * d * d.transpose();
            sum.stiffness.diagonal().array() += pair.first;
            visit(i, j, pull);
        }
        sum.force += force;
        sum.torque += place.cross(force);
    }
    return sum;
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

double SmoothEnds::reach() const noexcept {
    return std::max(cutoff, std::sqrt(SolvationLaw<>(solvation).reach2));
}

FieldSum evaluate_pair_field(const FieldPoints& group, const FieldPoints& environment,
                             const PairRule& rule) noexcept {
    if (rule.smooth) return sum_smooth_pairs(group, environment, rule, [](auto&&...) {});
    return sum_pairs(group, environment, rule, [](auto&&...) {});
}

FieldSum add_pair_forces(const FieldPoints& group, const FieldPoints& environment,
                         const PairRule& rule, std::span<Vec3> group_forces,
                         std::span<Vec3> environment_forces) noexcept {
    PALPA_ASSERT(group_forces.size() == group.positions.size());
    PALPA_ASSERT(environment_forces.size() == environment.positions.size());
    if (rule.smooth) {
        return sum_smooth_pairs(group, environment, rule,
                                [&](std::size_t i, std::size_t j, const Vec3& force) {
                                    group_forces[i] += force;
                                    environment_forces[j] -= force;
                                });
    }
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
