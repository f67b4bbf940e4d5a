#include "field/pair_field.h"

#include "core/units.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace palpa;

namespace {

constexpr double coulomb = units::charmm_coulomb_constant;

struct Points {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;

    FieldPoints view() const { return {positions, charge, sqrt_epsilon, half_rmin}; }
    void add(const Vec3& place, double q, double epsilon, double rmin_2) {
        positions.push_back(place);
        charge.push_back(q);
        sqrt_epsilon.push_back(std::sqrt(epsilon));
        half_rmin.push_back(rmin_2);
    }
};

Points random_points(std::mt19937& random, int count, double spread, const Vec3& centre) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Points points;
    for (int i = 0; i < count; ++i) {
        const Vec3 offset(uniform(random), uniform(random), uniform(random));
        points.add(centre + spread * offset, uniform(random), 0.1 + 0.05 * uniform(random),
                   1.5 + 0.5 * uniform(random));
    }
    return points;
}

Points translated(Points points, const Vec3& by) {
    for (Vec3& place : points.positions) place += by;
    return points;
}

}  // namespace

TEST_CASE("two argon-like points rest at Rmin with an energy of -epsilon", "[field][pair]") {
    Points a, b;
    a.add({0, 0, 0}, 0, 0.2, 1.9);
    b.add({3.8, 0, 0}, 0, 0.2, 1.9);

    const FieldSum sum = evaluate_pair_field(b.view(), a.view(), {coulomb});

    CHECK(sum.van_der_waals == Approx(-0.2).epsilon(1e-14));
    CHECK(sum.electrostatic == 0);
    CHECK(sum.force.norm() == Approx(0).margin(1e-13));
    // E'' at the minimum is 72 epsilon / Rmin^2, worked out by hand.
    CHECK(sum.stiffness(0, 0) == Approx(72 * 0.2 / (3.8 * 3.8)).epsilon(1e-13));
    CHECK(sum.stiffness(1, 1) == Approx(0).margin(1e-13));
}

TEST_CASE("two unit charges 2 Å apart repel as Coulomb says", "[field][pair]") {
    Points a, b;
    a.add({0, 0, 0}, 1, 0, 0);
    b.add({0, 2, 0}, 1, 0, 0);

    const FieldSum sum = evaluate_pair_field(b.view(), a.view(), {coulomb});

    CHECK(sum.electrostatic == Approx(332.0716 / 2).epsilon(1e-14));
    CHECK(sum.force.y() == Approx(332.0716 / 4).epsilon(1e-14));
    CHECK(sum.stiffness(1, 1) == Approx(2 * 332.0716 / 8).epsilon(1e-14));
    CHECK(sum.stiffness(0, 0) == Approx(-332.0716 / 8).epsilon(1e-14));
}

TEST_CASE("force and stiffness of a group are the derivatives of its energy", "[field][pair]") {
    std::mt19937 random(7);
    const Points environment = random_points(random, 12, 4, Vec3::Zero());
    const Points group = random_points(random, 5, 2, {6, 1, -2});
    const auto at = [&](const Vec3& by) {
        return evaluate_pair_field(translated(group, by).view(), environment.view(), {coulomb});
    };
    constexpr double h = 1e-5;

    const FieldSum sum = at(Vec3::Zero());

    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 d = h * Vec3::Unit(axis);
        const double slope = (at(d).energy() - at(-d).energy()) / (2 * h);
        const Vec3 turn = -(at(d).force - at(-d).force) / (2 * h);
        CHECK(sum.force(axis) == Approx(-slope).epsilon(1e-7).margin(1e-7));
        CHECK((sum.stiffness.col(axis) - turn).norm() < 1e-6 * (1 + turn.norm()));
    }
}

TEST_CASE("the torque is what turning the group costs, about any place", "[field][pair]") {
    std::mt19937 random(9);
    const Points environment = random_points(random, 11, 4, Vec3::Zero());
    const Points group = random_points(random, 6, 2, {6, -1, 2});
    const Vec3 centre(5, 0, 1);
    const auto energy = [&](const Vec3& axis, double angle) {
        Points turned = group;
        const Eigen::AngleAxisd turn(angle, axis);
        for (Vec3& place : turned.positions) place = centre + turn * (place - centre);
        return evaluate_pair_field(turned.view(), environment.view(), {coulomb}).energy();
    };
    constexpr double h = 1e-5;

    const FieldSum sum = evaluate_pair_field(group.view(), environment.view(), {coulomb});

    for (int i = 0; i < 3; ++i) {
        const Vec3 axis = Vec3::Unit(i);
        CHECK(sum.torque_about(centre)(i) ==
              Approx(-(energy(axis, h) - energy(axis, -h)) / (2 * h)).epsilon(1e-7).margin(1e-7));
    }
}

TEST_CASE("a replaced pair takes its own well, and only that pair does", "[field][pair]") {
    Points sodium, ions;
    sodium.add({0, 0, 0}, 0, 0.0469, 1.41075);
    std::vector<std::uint32_t> types;
    for (int i = 0; i < 7; ++i) {  // a chloride in any lane
        ions.add({0, 3.731 + i, 0}, 0, 0.15, 2.27);
        types.push_back(7);
    }
    const auto chloride = static_cast<std::size_t>(GENERATE(0, 3, 6));
    types[chloride] = 2;
    const std::vector<std::uint32_t> sodium_type{5};
    const std::vector<ReplacedPair> replaced{{2, 5, 0.083875, 3.731}, {2, 2, 9, 9}};
    FieldPoints group = sodium.view(), environment = ions.view();
    group.type = sodium_type;
    environment.type = types;

    const FieldSum plain = evaluate_pair_field(group, environment, {coulomb});
    const FieldSum sum = evaluate_pair_field(group, environment, {coulomb, replaced});
    const FieldSum turned = evaluate_pair_field(environment, group, {coulomb, replaced});

    const auto well = [](double epsilon, double rmin, double r) {
        const double s6 = std::pow(rmin / r, 6);
        return epsilon * (s6 * s6 - 2 * s6);
    };
    const double r = 3.731 + static_cast<double>(chloride);
    CHECK(sum.van_der_waals - plain.van_der_waals ==
          Approx(well(0.083875, 3.731, r) - well(std::sqrt(0.0469 * 0.15), 1.41075 + 2.27, r))
              .epsilon(1e-10));
    CHECK(turned.van_der_waals == Approx(sum.van_der_waals).epsilon(1e-14));
}

TEST_CASE("forces on single points add up to the group's, and to nothing over all",
          "[field][pair]") {
    std::mt19937 random(8);
    const Points environment = random_points(random, 9, 4, Vec3::Zero());
    const Points group = random_points(random, 4, 2, {5, 0, 0});
    std::vector<Vec3> on_group(4, Vec3::Zero()), on_environment(9, Vec3::Zero());

    const FieldSum sum =
        add_pair_forces(group.view(), environment.view(), {coulomb}, on_group, on_environment);

    Vec3 total = Vec3::Zero(), torque = Vec3::Zero(), of_group = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
        of_group += on_group[i];
        torque += group.positions[i].cross(on_group[i]);
    }
    total = of_group;
    for (std::size_t j = 0; j < 9; ++j) {
        total += on_environment[j];
        torque += environment.positions[j].cross(on_environment[j]);
    }
    CHECK((of_group - sum.force).norm() < 1e-10 * sum.force.norm());
    CHECK(total.norm() < 1e-10 * sum.force.norm());
    CHECK(torque.norm() < 1e-9 * sum.force.norm());
}

TEST_CASE("the field is finite and continuous at any distance, zero included", "[field][pair]") {
    const double tiny = std::numeric_limits<double>::denorm_min();
    Points oxygen, other;
    oxygen.add({0, 0, 0}, -0.834, 0.1521, 1.7682);
    const auto hydrogen = GENERATE(false, true);
    const auto at = [&](double distance) {
        other = {};
        other.add({distance, 0, 0}, hydrogen ? 0.417 : -0.834, hydrogen ? 0.046 : 0.1521,
                  hydrogen ? 0.2245 : 1.7682);
        return evaluate_pair_field(other.view(), oxygen.view(), {coulomb});
    };

    for (const double distance :
         {0.0, tiny, 1e-300, 1e-12, 1e-3, 0.05, 0.1, 0.5, 1.0, 1e3, 1e150}) {
        INFO("distance " << distance << " Å");
        const FieldSum sum = at(distance);
        CHECK(std::isfinite(sum.energy()));
        CHECK(sum.force.allFinite());
        CHECK(sum.stiffness.allFinite());
    }
    CHECK(at(0).force == Vec3(Vec3::Zero()));
    const FieldSum inside = at(pair_core_radius * (1 - 1e-12));
    const FieldSum outside = at(pair_core_radius * (1 + 1e-12));
    CHECK(inside.energy() == Approx(outside.energy()).epsilon(1e-9));
    CHECK(inside.force.x() == Approx(outside.force.x()).epsilon(1e-9));
    // Inside the core the force is still the derivative of the energy.
    constexpr double h = 1e-5;
    CHECK(at(0.04).force.x() ==
          Approx(-(at(0.04 + h).energy() - at(0.04 - h).energy()) / (2 * h)).epsilon(1e-6));
}
