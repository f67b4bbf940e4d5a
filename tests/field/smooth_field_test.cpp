// Fields with the smooth ends and the solvation of EEF1-SB: the reference against differences and
// closed forms, and the kernels against the reference.
#include "core/units.h"
#include "field/frozen_field.h"
#include "field/pair_kernel.h"
#include "field/processor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr double over_eps = units::charmm_coulomb_constant / 1.5;

struct WetPoints {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;
    std::vector<std::uint32_t> type;
    std::vector<double> volume, strength, inverse_lambda, radius;

    FieldPoints view() const {
        return {positions, charge, sqrt_epsilon,
                half_rmin, type,   {volume, strength, inverse_lambda, radius}};
    }
    void add(const Vec3& place, std::uint32_t kind, double q) {
        // An ion's nitrogen, a methyl, a carbonyl's carbon and a hydrogen.
        constexpr std::array<std::array<double, 5>, 4> kinds{{{11.2, -20, 6, 1.85, 0.2},
                                                              {27.9, 1.089, 3.5, 2.04, 0.08},
                                                              {14.7, 0, 3.5, 2, 0.11},
                                                              {0, 0, 1, 0, 0.046}}};
        const auto& [v, dg, lambda, r, epsilon] = kinds[kind];
        positions.push_back(place);
        charge.push_back(q);
        sqrt_epsilon.push_back(std::sqrt(epsilon));
        half_rmin.push_back(kind == 3 ? 0.9 : r);
        type.push_back(kind);
        volume.push_back(v);
        strength.push_back(dg / (2 * std::pow(3.14159265358979, 1.5) * lambda));
        inverse_lambda.push_back(1 / lambda);
        radius.push_back(r);
    }
};

WetPoints random_wet_points(std::mt19937& random, int x_count, int y_count, int z_count,
                            const Vec3& corner) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    WetPoints points;
    for (int i = 0; i < x_count * y_count * z_count; ++i) {
        const Vec3 cell(i % x_count, i / x_count % y_count, i / x_count / y_count);
        const double dx = uniform(random), dy = uniform(random), dz = uniform(random);
        points.add(corner + 2.5 * cell + 0.3 * Vec3(dx, dy, dz),
                   static_cast<std::uint32_t>(random() % 4), uniform(random));
    }
    return points;
}

WetPoints reordered(const WetPoints& points, std::span<const std::uint32_t> order) {
    WetPoints result;
    const auto take = [&](const auto& from, auto& to) {
        for (const std::uint32_t i : order) to.push_back(from[i]);
    };
    take(points.positions, result.positions);
    take(points.charge, result.charge);
    take(points.sqrt_epsilon, result.sqrt_epsilon);
    take(points.half_rmin, result.half_rmin);
    take(points.type, result.type);
    take(points.volume, result.volume);
    take(points.strength, result.strength);
    take(points.inverse_lambda, result.inverse_lambda);
    take(points.radius, result.radius);
    return result;
}

PairRule wet_rule(std::span<const ReplacedPair> replaced = {}) {
    return {over_eps, replaced, SmoothEnds{}};
}

WetPoints moved(WetPoints points, const RigidMotion& motion) {
    for (Vec3& place : points.positions) place = motion * place;
    return points;
}

// What errors are measured by: the largest force and stiffness of a single pair, of all pairs.
double largest_pair_stiffness(const WetPoints& group, const WetPoints& environment) {
    double largest = 0;
    for (std::size_t i = 0; i < group.positions.size(); ++i) {
        for (std::size_t j = 0; j < environment.positions.size(); ++j) {
            const double r = (group.positions[i] - environment.positions[j]).norm();
            if (r >= 9.5) continue;
            const double s6 = std::pow((group.half_rmin[i] + environment.half_rmin[j]) / r, 6);
            largest = std::max(largest, group.sqrt_epsilon[i] * environment.sqrt_epsilon[j] * s6 *
                                            (156 * s6 + 84) / (r * r));
        }
    }
    return largest;
}

}  // namespace

TEST_CASE("a pair with smooth ends has the energies of their formulas", "[field][smooth]") {
    WetPoints ion, methyl;
    ion.add(Vec3::Zero(), 0, 0.5);
    for (const double r : {2.5, 4.0, 6.9, 7.5, 8.7, 9.3, 9.6}) {
        methyl = {};
        methyl.add({0, r, 0}, 1, -0.3);
        const FieldSum sum = evaluate_pair_field(ion.view(), methyl.view(), wet_rule());

        const double q = std::min(1.0, r * r / 81);
        CHECK(sum.electrostatic == Approx(-0.15 * over_eps / (r * r) * std::pow(1 - q, 3)));
        const double s6 = std::pow((1.85 + 2.04) / r, 6), y = std::clamp((r * r - 49) / 32, 0., 1.);
        CHECK(sum.van_der_waals == Approx(std::sqrt(0.2 * 0.08) * (s6 * s6 - 2 * s6) *
                                          (1 - std::pow(y, 3) * (10 - 15 * y + 6 * y * y))));
        const double t = std::clamp(r - 8.5, 0., 1.);
        const auto taken = [&](double dg, double v, double lambda, double R) {
            return dg * v / (2 * std::pow(3.14159265358979, 1.5) * lambda) *
                   std::exp(-std::pow((r - R) / lambda, 2)) / (r * r);
        };
        CHECK(sum.solvation == Approx(-(taken(-20, 27.9, 6, 1.85) + taken(1.089, 11.2, 3.5, 2.04)) *
                                      (1 - std::pow(t, 3) * (10 - 15 * t + 6 * t * t)))
                                   .margin(1e-13));
        CHECK(sum.energy() == sum.van_der_waals + sum.electrostatic + sum.solvation);
    }
}

TEST_CASE("force and stiffness of a field with smooth ends are the energy's derivatives",
          "[field][smooth]") {
    std::mt19937 random(5);
    const WetPoints environment = random_wet_points(random, 6, 6, 4, Vec3(3, 1, -2));
    const WetPoints group = random_wet_points(random, 3, 2, 2, Vec3(7, 6, 8.5));
    const std::vector<ReplacedPair> replaced{{0, 1, 0.2, 3.4}};
    const FieldSum sum = evaluate_pair_field(group.view(), environment.view(), wet_rule(replaced));
    const auto at = [&](const Vec3& by) {
        return evaluate_pair_field(moved(group, {Mat3::Identity(), by}).view(), environment.view(),
                                   wet_rule(replaced));
    };
    constexpr double h = 1e-4;
    for (int axis = 0; axis < 3; ++axis) {
        const FieldSum forth = at(h * Vec3::Unit(axis)), back = at(-h * Vec3::Unit(axis));
        const FieldSum far = at(2 * h * Vec3::Unit(axis)), rear = at(-2 * h * Vec3::Unit(axis));
        const double slope =
            (8 * (forth.energy() - back.energy()) - (far.energy() - rear.energy())) / (12 * h);
        const Vec3 bent = (8 * (forth.force - back.force) - (far.force - rear.force)) / (12 * h);
        CHECK(std::abs(sum.force[axis] + slope) < 1e-8 * (1 + sum.force.norm()));
        CHECK((sum.stiffness.col(axis) + bent).norm() < 1e-8 * (1 + sum.stiffness.norm()));
    }
    std::vector<Vec3> on_group(group.positions.size(), Vec3::Zero());
    std::vector<Vec3> on_others(environment.positions.size(), Vec3::Zero());
    add_pair_forces(group.view(), environment.view(), wet_rule(replaced), on_group, on_others);
    Vec3 force = Vec3::Zero(), other = Vec3::Zero();
    for (const Vec3& f : on_group) force += f;
    for (const Vec3& f : on_others) other += f;
    CHECK((force - sum.force).norm() < 1e-12 * (1 + sum.force.norm()));
    CHECK((other + sum.force).norm() < 1e-12 * (1 + sum.force.norm()));
    // On top of each other.
    const FieldSum same = evaluate_pair_field(group.view(), group.view(), wet_rule());
    CHECK(std::isfinite(same.energy()));
    CHECK(same.stiffness.allFinite());
}

TEST_CASE("a frozen field with smooth ends agrees with the reference, in any order of its points",
          "[field][frozen][smooth]") {
    std::mt19937 random(11);
    const Vec3 corner(100, -50, 20);
    const WetPoints unordered = random_wet_points(random, 10, 10, GENERATE(1, 10, 17), corner);
    const WetPoints group = random_wet_points(random, 5, 5, 5, corner + Vec3(5, 4, -14.5));
    std::vector<std::uint8_t> counts;
    for (const double volume : unordered.volume) counts.push_back(volume != 0);
    const bool is_ordered = GENERATE(false, true);
    const WetPoints environment =
        is_ordered ? reordered(unordered, order_for_sixteens(unordered.positions, counts))
                   : unordered;
    const std::vector<ReplacedPair> replaced{{1, 2, 0.02, 4.1}, {3, 3, 0.3, 2.2}};
    const PairRule rule = wet_rule(GENERATE(false, true) ? std::span<const ReplacedPair>(replaced)
                                                         : std::span<const ReplacedPair>());
    const FrozenField field = build_frozen_field(group.view(), environment.view(), rule);
    const RigidMotion motion{
        Eigen::AngleAxisd(0.01, Vec3(1, 2, -1).normalized()).toRotationMatrix(),
        Vec3(0.3, -0.4, -0.5)};
    const WetPoints there = moved(group, motion);
    const FieldSum expected = evaluate_pair_field(there.view(), environment.view(), rule);
    double clearance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < there.positions.size(); ++i) {
        for (std::size_t j = 0; j < environment.positions.size(); ++j) {
            double rmin = there.half_rmin[i] + environment.half_rmin[j];
            for (const ReplacedPair& pair : rule.replaced) {
                if (std::minmax(there.type[i], environment.type[j]) == std::minmax(pair.a, pair.b))
                    rmin = pair.rmin;
            }
            clearance =
                std::min(clearance, (there.positions[i] - environment.positions[j]).norm() - rmin);
        }
    }
    const double scale = largest_pair_stiffness(there, environment);
    for (const std::string& kind : list_processor_kinds()) {
        INFO(kind);
        use_processor_kind(kind);
        const FrozenSum sum = evaluate_frozen_field(field, group.positions, motion);
        CHECK((sum.force - expected.force).norm() < 5e-6 * (expected.force.norm() + scale));
        CHECK((sum.torque_about(field.origin) - expected.torque_about(field.origin)).norm() <
              5e-6 * (expected.torque_about(field.origin).norm() + 10 * scale));
        CHECK((sum.stiffness - expected.stiffness).norm() <
              5e-6 * (expected.stiffness.norm() + scale));
        CHECK(sum.clearance == Approx(clearance).margin(1e-5));
        const FieldSum energies = evaluate_field_and_energies(field, there.positions);
        CHECK(energies.van_der_waals == Approx(expected.van_der_waals).epsilon(1e-5).margin(1e-3));
        CHECK(energies.electrostatic == Approx(expected.electrostatic).epsilon(1e-5).margin(1e-4));
        CHECK(energies.solvation == Approx(expected.solvation).epsilon(2e-6));
    }
    use_processor_kind(list_processor_kinds().front());
    // Out of reach there is nothing, and the clearance a bound below the truth.
    const FrozenSum away =
        evaluate_frozen_field(field, group.positions, {Mat3::Identity(), Vec3(0, 0, -60)});
    CHECK(away.force == Vec3::Zero());
    CHECK(away.stiffness == Mat3::Zero());
    CHECK(away.clearance > 4.5);
    CHECK(away.clearance < 9.5);
    // So near that single precision does not do.
    WetPoints close = group;
    close.positions[3] = environment.positions[7];
    const FrozenSum in_double = evaluate_frozen_field(field, close.positions);
    const FieldSum reference = evaluate_pair_field(close.view(), environment.view(), rule);
    CHECK((in_double.force - reference.force).norm() <= 1e-9 * reference.force.norm());
}

TEST_CASE("an order for sixteens has every point once, those with solvation first and together",
          "[field][frozen][smooth]") {
    std::mt19937 random(3);
    const WetPoints points = random_wet_points(random, 9, 7, 8, Vec3::Zero());
    std::vector<std::uint8_t> counts;
    for (const double volume : points.volume) counts.push_back(volume != 0);
    const std::vector<std::uint32_t> order = order_for_sixteens(points.positions, counts);
    std::vector<std::uint32_t> sorted = order;
    std::ranges::sort(sorted);
    for (std::uint32_t i = 0; i < sorted.size(); ++i) REQUIRE(sorted[i] == i);
    CHECK(std::ranges::is_partitioned(order, [&](std::uint32_t i) { return counts[i] != 0; }));
    // A sixteen of every fourth place is about as wide as a cube of 2.5 Å 64^(1/3).
    double widest = 0;
    for (std::size_t first = 0; first + 16 <= order.size(); first += 16) {
        if (counts[order[first]] == 0 || counts[order[first + 15]] == 0) continue;
        for (std::size_t k = first; k < first + 16; ++k)
            widest = std::max(widest,
                              (points.positions[order[k]] - points.positions[order[first]]).norm());
    }
    CHECK(widest < 16);
    CHECK(order_for_sixteens({}).empty());
}

TEST_CASE("points that follow in a field with smooth ends have the energy's slope and curvature",
          "[field][frozen][following][smooth]") {
    std::mt19937 random(29);
    const WetPoints group = random_wet_points(random, 3, 3, 2, Vec3(20, 30, -10));
    const WetPoints environment = random_wet_points(random, 7, 6, 5, Vec3(22, 28, -4.5));
    std::uniform_real_distribution<double> uniform(-0.6, 0.6);
    const auto matrix = [&] { return Mat3(Mat3::NullaryExpr([&] { return uniform(random); })); };
    std::vector<Mat3> group_moves, environment_moves;
    for (std::size_t i = 0; i < group.positions.size(); ++i)
        group_moves.push_back(Mat3::Identity() + matrix());
    for (std::size_t j = 0; j < environment.positions.size(); ++j)
        environment_moves.push_back(matrix());
    const auto at = [&](const Vec3& by) {
        WetPoints own = group, others = environment;
        for (std::size_t i = 0; i < own.positions.size(); ++i)
            own.positions[i] += group_moves[i] * by;
        for (std::size_t j = 0; j < others.positions.size(); ++j)
            others.positions[j] += environment_moves[j] * by;
        return evaluate_pair_field(own.view(), others.view(), wet_rule());
    };
    const auto energy = [&](const Vec3& by) { return at(by).energy(); };
    const FrozenField field = build_frozen_field(group.view(), environment.view(), wet_rule());
    const FollowingPoints points = build_following_points(group_moves, environment_moves);
    FollowingMemory memory = build_following_memory(field);
    for (const Vec3& by : {Vec3(0, 0, 0), Vec3(0.1, -0.2, 0.15), Vec3(-0.3, 0.1, 0)}) {
        const FollowingSum there =
            evaluate_following_field(field, group.positions, points, by, memory);
        constexpr double h = 1e-3;
        Vec3 along;
        Mat3 slope;
        for (int i = 0; i < 3; ++i) {
            const Vec3 a = h * Vec3::Unit(i);
            along[i] = -(energy(by + a) - energy(by - a)) / (2 * h);
            for (int k = 0; k < 3; ++k) {
                const Vec3 b = h * Vec3::Unit(k);
                slope(i, k) = (energy(by + a + b) - energy(by + a - b) - energy(by - a + b) +
                               energy(by - a - b)) /
                              (4 * h * h);
            }
        }
        CHECK((there.along - along).norm() < 1e-4 * along.norm());
        CHECK((there.slope - slope).norm() < 1e-3 * slope.norm());
        const FieldSum expected = at(by);
        CHECK((there.sum.force - expected.force).norm() < 1e-5 * expected.force.norm());
        CHECK((there.sum.torque - expected.torque).norm() < 1e-5 * expected.torque.norm());
        CHECK((there.sum.stiffness - expected.stiffness).norm() < 1e-5 * expected.stiffness.norm());
    }
}
