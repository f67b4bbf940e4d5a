#include "field/frozen_field.h"

#include "core/units.h"
#include "field/pair_kernel.h"
#include "field/processor.h"

#include <algorithm>
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

constexpr double coulomb_constant = units::charmm_coulomb_constant;

struct PointSet {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;
    std::vector<std::uint32_t> type;

    FieldPoints view() const { return {positions, charge, sqrt_epsilon, half_rmin, type}; }
};

// A box of places 2.5 Å apart, shaken; as dense as a protein is without its hydrogens.
PointSet random_points(std::mt19937& random, int x_count, int y_count, int z_count,
                       const Vec3& corner) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    PointSet points;
    for (int i = 0; i < x_count * y_count * z_count; ++i) {
        const int row = i / x_count % y_count, layer = i / x_count / y_count;
        const Vec3 cell(i % x_count, row, layer);
        const double dx = uniform(random), dy = uniform(random), dz = uniform(random);
        points.positions.push_back(corner + 2.5 * cell + 0.3 * Vec3(dx, dy, dz));
        points.charge.push_back(uniform(random));
        const int type = i % 4;
        points.type.push_back(static_cast<std::uint32_t>(type));
        points.sqrt_epsilon.push_back(std::sqrt(0.05 + 0.03 * type));
        points.half_rmin.push_back(0.9 + 0.25 * type);
    }
    return points;
}

// What errors are measured by: every pair's numbers, all positive.
struct Magnitude {
    double force = 0, torque = 0, stiffness = 0, van_der_waals = 0, electrostatic = 0;
};
Magnitude sum_magnitudes(const PointSet& group, const PointSet& environment, const Vec3& origin) {
    Magnitude sum;
    for (std::size_t i = 0; i < group.positions.size(); ++i) {
        for (std::size_t j = 0; j < environment.positions.size(); ++j) {
            const double r = (group.positions[i] - environment.positions[j]).norm();
            const double rmin = group.half_rmin[i] + environment.half_rmin[j];
            const double s6 = std::pow(rmin / r, 6);
            const double well = group.sqrt_epsilon[i] * environment.sqrt_epsilon[j] * s6;
            const double charges =
                std::abs(coulomb_constant * group.charge[i] * environment.charge[j]) / r;
            const double force = (12 * well * (s6 + 1) + charges) / r;
            sum.force += force;
            sum.torque += force * std::max(1.0, (group.positions[i] - origin).norm());
            sum.stiffness += (well * (156 * s6 + 84) + 2 * charges) / (r * r);
            sum.van_der_waals += well * (s6 + 2);
            sum.electrostatic += charges;
        }
    }
    return sum;
}

// Pair by pair: what limits how far the group may go.
struct Nearness {
    double clearance = std::numeric_limits<double>::infinity(), largest_force = 0;
};
Nearness find_nearness(const PointSet& group, const PointSet& environment, const PairRule& rule) {
    Nearness nearness;
    for (std::size_t i = 0; i < group.positions.size(); ++i) {
        Vec3 force = Vec3::Zero();
        for (std::size_t j = 0; j < environment.positions.size(); ++j) {
            const Vec3 d = group.positions[i] - environment.positions[j];
            double rmin = group.half_rmin[i] + environment.half_rmin[j];
            double epsilon = group.sqrt_epsilon[i] * environment.sqrt_epsilon[j];
            for (const ReplacedPair& pair : rule.replaced) {
                if (std::minmax(group.type[i], environment.type[j]) != std::minmax(pair.a, pair.b))
                    continue;
                rmin = pair.rmin;
                epsilon = pair.epsilon;
            }
            const double r = d.norm(), s6 = std::pow(rmin / r, 6);
            const double charges = coulomb_constant * group.charge[i] * environment.charge[j];
            force += (12 * epsilon * s6 * (s6 - 1) + charges / r) / (r * r) * d;
            nearness.clearance = std::min(nearness.clearance, r - rmin);
        }
        nearness.largest_force = std::max(nearness.largest_force, force.norm());
    }
    return nearness;
}

}  // namespace

TEST_CASE("a frozen field agrees with the reference on every kind of processor",
          "[field][frozen]") {
    std::mt19937 random(11);
    const Vec3 corner(100, -50, 20);  // of the molecule in its frame
    const PointSet environment = random_points(random, 10, 10, GENERATE(1, 10, 23), corner);
    const PointSet group = random_points(random, 5, 5, 5, corner + Vec3(5, 4, -14.5));
    const bool with_replaced = GENERATE(false, true);
    std::vector<ReplacedPair> replaced;
    if (with_replaced) replaced = {{1, 2, 0.02, 4.1}, {3, 3, 0.3, 2.2}};
    const PairRule rule{coulomb_constant, replaced};
    const FrozenField field = build_frozen_field(group.view(), environment.view(), rule);
    const FieldSum expected = evaluate_pair_field(group.view(), environment.view(), rule);
    const Magnitude scale = sum_magnitudes(group, environment, field.origin);
    const Nearness near = find_nearness(group, environment, rule);

    for (const std::string& kind : list_processor_kinds()) {
        INFO(kind);
        use_processor_kind(kind);
        const FrozenSum sum = evaluate_frozen_field(field, group.positions);

        CHECK(sum.clearance == Approx(near.clearance).margin(1e-5));
        CHECK(sum.largest_force == Approx(near.largest_force).epsilon(2e-5));
        CHECK((sum.force - expected.force).norm() < 2e-6 * scale.force);
        CHECK((sum.torque_about(field.origin) - expected.torque_about(field.origin)).norm() <
              2e-6 * scale.torque);
        CHECK((sum.stiffness - expected.stiffness).norm() < 2e-6 * scale.stiffness);
        // And where a hand feels it, in what it feels.
        CHECK((sum.force - expected.force).norm() < 2e-5 * expected.force.norm());
        CHECK((sum.stiffness - expected.stiffness).norm() < 2e-5 * expected.stiffness.norm());

        const FieldSum with_energies = evaluate_field_and_energies(field, group.positions);
        CHECK(std::abs(with_energies.van_der_waals - expected.van_der_waals) <
              1e-6 * scale.van_der_waals);
        CHECK(std::abs(with_energies.electrostatic - expected.electrostatic) <
              1e-6 * scale.electrostatic);
        CHECK(with_energies.force == sum.force);
        CHECK(with_energies.torque == sum.torque);
        CHECK(with_energies.stiffness == sum.stiffness);
    }
    use_processor_kind(list_processor_kinds().front());
}

TEST_CASE("sums over many points that all push one way lose no digits", "[field][frozen]") {
    std::mt19937 random(16);
    PointSet environment = random_points(random, 50, 50, 40, Vec3::Zero());
    std::ranges::fill(environment.charge, 0.5);
    PointSet group = random_points(random, 1, 1, 1, Vec3(60, 60, 120));
    group.charge[0] = 0.5;
    const FrozenField field =
        build_frozen_field(group.view(), environment.view(), {coulomb_constant});
    const FieldSum expected =
        evaluate_pair_field(group.view(), environment.view(), {coulomb_constant});
    const Magnitude scale = sum_magnitudes(group, environment, field.origin);

    for (const std::string& kind : list_processor_kinds()) {
        INFO(kind);
        use_processor_kind(kind);
        const FrozenSum sum = evaluate_frozen_field(field, group.positions);
        CHECK((sum.force - expected.force).norm() < 1e-6 * scale.force);
    }
    use_processor_kind(list_processor_kinds().front());
}

TEST_CASE("the frozen field of nothing, or on nothing, is none", "[field][frozen]") {
    std::mt19937 random(12);
    const PointSet some = random_points(random, 2, 2, 2, Vec3::Zero()), none;

    const FrozenField of_none = build_frozen_field(some.view(), none.view(), {coulomb_constant});
    const FrozenField on_none = build_frozen_field(none.view(), some.view(), {coulomb_constant});

    CHECK(evaluate_frozen_field(of_none, some.positions).force == Vec3(Vec3::Zero()));
    CHECK(evaluate_frozen_field(on_none, none.positions).stiffness == Mat3(Mat3::Zero()));
    CHECK(evaluate_field_and_energies(of_none, some.positions).energy() == 0);
    CHECK(evaluate_field_and_energies(on_none, none.positions).energy() == 0);
}

TEST_CASE("a group that is moved and turned feels what one that stands there feels",
          "[field][frozen]") {
    std::mt19937 random(14);
    const PointSet environment = random_points(random, 4, 4, 4, Vec3::Zero());
    PointSet group = random_points(random, 2, 2, 2, Vec3(3, 3, 9));
    const FrozenField field =
        build_frozen_field(group.view(), environment.view(), {coulomb_constant});
    RigidMotion motion = turn_about(Vec3(3, 3, 9), Vec3(0.6, 0, 0.8), 0.7);
    motion.translation += Vec3(0.3, -0.2, 1);

    const FrozenSum moved = evaluate_frozen_field(field, group.positions, motion);
    for (Vec3& place : group.positions) place = motion * place;
    const FrozenSum there = evaluate_frozen_field(field, group.positions);

    CHECK((moved.force - there.force).norm() < 1e-5 * there.force.norm());
    CHECK((moved.torque - there.torque).norm() < 1e-5 * there.torque.norm());
    CHECK(moved.clearance == Approx(there.clearance).margin(1e-5));
}

TEST_CASE("single precision does until two points are nearer than its limit", "[field][frozen]") {
    std::mt19937 random(15);
    const PointSet environment = random_points(random, 3, 3, 3, Vec3::Zero());
    PointSet group = random_points(random, 2, 2, 2, Vec3(0, 0, 9));
    const double distance = GENERATE(0.98, 1.02) * nearest_single_precision;
    group.positions[5] = environment.positions[6] + Vec3(0, distance, 0);

    const FrozenField field =
        build_frozen_field(group.view(), environment.view(), {coulomb_constant});
    const FrozenSum sum = evaluate_frozen_field(field, group.positions);
    const FieldSum reference =
        evaluate_pair_field(group.view(), environment.view(), {coulomb_constant});

    // Beyond it differs, by no more than single precision; below it is the reference's.
    const bool is_reference = distance < nearest_single_precision;
    CHECK(((sum.force - reference.force).norm() == 0) == is_reference);
    CHECK((sum.force - reference.force).norm() < 2e-6 * reference.force.norm());
}

TEST_CASE("where single precision does not do, a frozen field is the reference's",
          "[field][frozen]") {
    std::mt19937 random(13);
    const PointSet environment = random_points(random, 3, 3, 3, Vec3::Zero());
    PointSet group = random_points(random, 2, 2, 2, Vec3(0, 0, 9));
    SECTION("two points near each other") {
        group.positions[5] = environment.positions[6] + Vec3(0.3, 0, 0);
    }
    SECTION("two points at one place") { group.positions[5] = environment.positions[6]; }
    SECTION("a point far off") { group.positions[5].x() = 1e5; }

    const FrozenField field =
        build_frozen_field(group.view(), environment.view(), {coulomb_constant});
    const FrozenSum sum = evaluate_frozen_field(field, group.positions);
    const FieldSum expected =
        evaluate_pair_field(group.view(), environment.view(), {coulomb_constant});
    const Nearness near = find_nearness(group, environment, {coulomb_constant});
    const FieldSum with_energies = evaluate_field_and_energies(field, group.positions);

    CHECK(with_energies.energy() == expected.energy());
    CHECK(with_energies.torque == expected.torque);
    CHECK((sum.force - expected.force).norm() <= 1e-12 * expected.force.norm());
    CHECK((sum.stiffness - expected.stiffness).norm() <= 1e-12 * expected.stiffness.norm());
    CHECK(sum.clearance == Approx(near.clearance).margin(1e-12));
    // At one place a pair has no force; the other numbers are another way to the same.
    if (near.clearance > -1.9)
        CHECK(sum.largest_force == Approx(near.largest_force).epsilon(1e-12));
}

namespace {

// A group between others, all of which follow three coordinates, each in its own way.
struct Followed {
    PointSet group, environment;
    std::vector<Mat3> group_moves, environment_moves;
    std::vector<ReplacedPair> replaced;

    explicit Followed(std::mt19937& random) {
        group = random_points(random, 3, 3, 2, Vec3(20, 30, -10));
        environment = random_points(random, 7, 6, 5, Vec3(22, 28, -4.5));
        std::uniform_real_distribution<double> uniform(-0.6, 0.6);
        const auto matrix = [&] {
            return Mat3(Mat3::NullaryExpr([&] { return uniform(random); }));
        };
        for (std::size_t i = 0; i < group.positions.size(); ++i)
            group_moves.push_back(Mat3::Identity() + matrix());
        for (std::size_t j = 0; j < environment.positions.size(); ++j)
            environment_moves.push_back(matrix());
        replaced.push_back({.a = 1, .b = 2, .epsilon = 0.3, .rmin = 2.9});
    }

    PairRule rule() const { return {coulomb_constant, replaced}; }
    FrozenField field() const {
        return build_frozen_field(group.view(), environment.view(), rule());
    }
    FieldSum at(const Vec3& by, std::vector<Vec3>* of_group = nullptr) const {
        PointSet own = group, others = environment;
        for (std::size_t i = 0; i < own.positions.size(); ++i)
            own.positions[i] += group_moves[i] * by;
        for (std::size_t j = 0; j < others.positions.size(); ++j)
            others.positions[j] += environment_moves[j] * by;
        if (of_group) *of_group = own.positions;
        return evaluate_pair_field(own.view(), others.view(), rule());
    }
    double energy(const Vec3& by) const { return at(by).energy(); }
};

}  // namespace

TEST_CASE("points that follow have the energy's slope and curvature along the coordinates",
          "[field][frozen][following]") {
    std::mt19937 random(29);
    const Followed c(random);
    const FrozenField field = c.field();
    const FollowingPoints points = build_following_points(c.group_moves, c.environment_moves);
    FollowingMemory memory = build_following_memory(field);
    for (const Vec3& by : {Vec3(0, 0, 0), Vec3(0.1, -0.2, 0.15), Vec3(-0.3, 0.1, 0)}) {
        const FollowingSum there =
            evaluate_following_field(field, c.group.positions, points, by, memory);

        constexpr double h = 1e-3;
        Vec3 along;
        Mat3 slope;
        for (int i = 0; i < 3; ++i) {
            const Vec3 a = h * Vec3::Unit(i);
            along[i] = -(c.energy(by + a) - c.energy(by - a)) / (2 * h);
            for (int k = 0; k < 3; ++k) {
                const Vec3 b = h * Vec3::Unit(k);
                slope(i, k) = (c.energy(by + a + b) - c.energy(by + a - b) - c.energy(by - a + b) +
                               c.energy(by - a - b)) /
                              (4 * h * h);
            }
        }
        CHECK((there.along - along).norm() < 1e-4 * along.norm());
        CHECK((there.slope - slope).norm() < 1e-3 * slope.norm());
        const FieldSum expected = c.at(by);
        CHECK((there.sum.force - expected.force).norm() < 1e-5 * expected.force.norm());
        CHECK((there.sum.torque - expected.torque).norm() < 1e-5 * expected.torque.norm());
        CHECK((there.sum.stiffness - expected.stiffness).norm() < 1e-5 * expected.stiffness.norm());
    }
}

TEST_CASE("a group that goes as one between points that stay is a frozen field's to the bit",
          "[field][frozen][following]") {
    std::mt19937 random(30);
    Followed c(random);
    const FrozenField field = c.field();
    c.group_moves.assign(c.group_moves.size(), Mat3::Identity());
    c.environment_moves.assign(c.environment_moves.size(), Mat3::Zero());
    const FollowingPoints points = build_following_points(c.group_moves, c.environment_moves);
    FollowingMemory memory = build_following_memory(field);

    const FollowingSum following =
        evaluate_following_field(field, c.group.positions, points, Vec3::Zero(), memory);
    const FrozenSum frozen = evaluate_frozen_field(field, c.group.positions);

    CHECK(following.sum.force == frozen.force);
    CHECK(following.sum.stiffness == frozen.stiffness);
    CHECK(following.sum.clearance == frozen.clearance);
    CHECK(following.sum.largest_force == frozen.largest_force);
    CHECK((following.along - frozen.force).norm() < 1e-5 * frozen.force.norm());
    CHECK((following.slope - frozen.stiffness).norm() < 1e-5 * frozen.stiffness.norm());
}

TEST_CASE("points too near for single precision follow by the reference",
          "[field][frozen][following]") {
    std::mt19937 random(31);
    Followed c(random);
    const Vec3 by(0.05, 0, 0.02);
    std::vector<Vec3> places;
    (void)c.at(by, &places);
    c.environment.positions[0] =
        places[0] - c.environment_moves[0] * by + Vec3(0.3 * nearest_single_precision, 0, 0);
    const FrozenField field = c.field();
    const FollowingPoints points = build_following_points(c.group_moves, c.environment_moves);
    FollowingMemory memory = build_following_memory(field);

    const FollowingSum there =
        evaluate_following_field(field, c.group.positions, points, by, memory);

    const FieldSum expected = c.at(by);
    CHECK((there.sum.force - expected.force).norm() < 1e-9 * expected.force.norm());
    CHECK((there.sum.torque - expected.torque).norm() < 1e-9 * expected.torque.norm());
    CHECK((there.sum.stiffness - expected.stiffness).norm() < 1e-9 * expected.stiffness.norm());
    const Vec3 D = (c.group_moves[0] - c.environment_moves[0]).transpose() * there.sum.force;
    CHECK((there.along - D).norm() < 1e-3 * D.norm());
    CHECK(there.sum.clearance < -1);
}
