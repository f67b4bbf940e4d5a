#include "field/frozen_field.h"

#include "core/units.h"
#include "field/processor.h"

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

constexpr double coulomb = units::charmm_coulomb_constant;

struct Points {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;
    std::vector<std::uint32_t> type;

    FieldPoints view() const { return {positions, charge, sqrt_epsilon, half_rmin, type}; }
};

// A box of places 2.5 Å apart, shaken; as dense as a protein is without its hydrogens.
Points random_points(std::mt19937& random, int x_count, int y_count, int z_count,
                     const Vec3& corner) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Points points;
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
    double energy = 0, force = 0, torque = 0, stiffness = 0;
};
Magnitude sum_magnitudes(const Points& group, const Points& environment, const Vec3& origin) {
    Magnitude sum;
    for (std::size_t i = 0; i < group.positions.size(); ++i) {
        for (std::size_t j = 0; j < environment.positions.size(); ++j) {
            const double r = (group.positions[i] - environment.positions[j]).norm();
            const double rmin = group.half_rmin[i] + environment.half_rmin[j];
            const double s6 = std::pow(rmin / r, 6);
            const double well = group.sqrt_epsilon[i] * environment.sqrt_epsilon[j] * s6;
            const double charges = std::abs(coulomb * group.charge[i] * environment.charge[j]) / r;
            const double force = (12 * well * (s6 + 1) + charges) / r;
            sum.energy += well * (s6 + 2) + charges;
            sum.force += force;
            sum.torque += force * std::max(1.0, (group.positions[i] - origin).norm());
            sum.stiffness += (well * (156 * s6 + 84) + 2 * charges) / (r * r);
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("a frozen field agrees with the twin on every kind of processor", "[field][frozen]") {
    std::mt19937 random(11);
    const Vec3 corner(100, -50, 20);  // of the molecule in its frame
    const Points environment = random_points(random, 10, 10, GENERATE(1, 10, 23), corner);
    const Points group = random_points(random, 5, 5, 5, corner + Vec3(5, 4, -14.5));
    const bool with_replaced = GENERATE(false, true);
    std::vector<ReplacedPair> replaced;
    if (with_replaced) replaced = {{1, 2, 0.02, 4.1}, {3, 3, 0.3, 2.2}};
    const PairRule rule{coulomb, replaced};
    const FrozenField field = build_frozen_field(group.view(), environment.view(), rule);
    const FieldSum expected = evaluate_pair_field(group.view(), environment.view(), rule);
    const Magnitude scale = sum_magnitudes(group, environment, field.origin);

    for (const std::string& kind : list_processor_kinds()) {
        INFO(kind);
        use_processor_kind(kind);
        const FieldSum sum = evaluate_frozen_field(field, group.positions);

        CHECK(std::abs(sum.van_der_waals - expected.van_der_waals) < 1e-6 * scale.energy);
        CHECK(std::abs(sum.electrostatic - expected.electrostatic) < 1e-6 * scale.energy);
        CHECK((sum.force - expected.force).norm() < 2e-6 * scale.force);
        CHECK((sum.torque_about(field.origin) - expected.torque_about(field.origin)).norm() <
              2e-6 * scale.torque);
        CHECK((sum.stiffness - expected.stiffness).norm() < 2e-6 * scale.stiffness);
        // And where a hand feels it, in what it feels.
        CHECK((sum.force - expected.force).norm() < 2e-5 * expected.force.norm());
        CHECK((sum.stiffness - expected.stiffness).norm() < 2e-5 * expected.stiffness.norm());
    }
    use_processor_kind(list_processor_kinds().front());
}

TEST_CASE("the frozen field of nothing, or on nothing, is none", "[field][frozen]") {
    std::mt19937 random(12);
    const Points some = random_points(random, 2, 2, 2, Vec3::Zero()), none;

    const FrozenField of_none = build_frozen_field(some.view(), none.view(), {coulomb});
    const FrozenField on_none = build_frozen_field(none.view(), some.view(), {coulomb});

    CHECK(evaluate_frozen_field(of_none, some.positions).energy() == 0);
    CHECK(evaluate_frozen_field(of_none, some.positions).force == Vec3(Vec3::Zero()));
    CHECK(evaluate_frozen_field(on_none, none.positions).stiffness == Mat3(Mat3::Zero()));
}

TEST_CASE("where single precision does not do, a frozen field is the twin's to the bit",
          "[field][frozen]") {
    std::mt19937 random(13);
    const Points environment = random_points(random, 3, 3, 3, Vec3::Zero());
    Points group = random_points(random, 2, 2, 2, Vec3(0, 0, 9));
    SECTION("two points at one place") { group.positions[5] = environment.positions[6]; }
    SECTION("a point far off") { group.positions[5].x() = 1e5; }

    const FrozenField field = build_frozen_field(group.view(), environment.view(), {coulomb});
    const FieldSum sum = evaluate_frozen_field(field, group.positions);
    const FieldSum expected = evaluate_pair_field(group.view(), environment.view(), {coulomb});

    CHECK(sum.energy() == expected.energy());
    CHECK(sum.force == expected.force);
    CHECK(sum.stiffness == expected.stiffness);
}
