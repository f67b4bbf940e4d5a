#include "simulation/grip_queries.h"

#include "simulation/probe.h"
#include "simulation/solver.h"
#include "tests/support/held_scene.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

using namespace palpa;

TEST_CASE("around a hand is all but what it holds, wherever that stands in the table",
          "[simulation][held]") {
    const std::size_t number = GENERATE(0, 1, 2);
    const World world = test::three_waters(number, {0, 4, 1});
    const Entity hand = hand_at(world, 0);

    const AtomRange held = held_range(world, hand);
    const std::vector<std::uint32_t> around = test::atoms_around(world);

    CHECK((held.first == 3 * number && held.count == 3));
    CHECK(held_points(world, hand).positions.front() == grabbed_place(world));
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < 9; ++i) {
        if (i / 3 != number) expected.push_back(i);
    }
    CHECK(around == expected);
    CHECK(count_environment(world, hand) == 6);
    CHECK(environment_of(world, hand).size() == (number == 1 ? 2 : 1));
}

TEST_CASE("a hand that holds nothing has nothing, and all is around it", "[simulation][held]") {
    World world = test::three_waters(1, {0, 4, 1});
    const Entity hand = hand_at(world, 0);
    world.remove<Grip>(hand);

    CHECK(held_range(world, hand).count == 0);
    CHECK(held_atoms(world, hand).empty());
    CHECK(held_points(world, hand).positions.empty());
    CHECK(spring_of(world, hand) == nullptr);
    CHECK(count_environment(world, hand) == 9);
    CHECK(test::atoms_around(world).size() == 9);
    CHECK(field_on_held(world, hand).force.norm() == 0);
    CHECK(find_force_on_held(world, hand).norm() == 0);
    CHECK(find_pull_on_held(world, hand).norm() == 0);
    // Nor has nobody.
    CHECK(hand_at(World(), 0) == Entity{});
    CHECK(held_range(world, Entity{}).count == 0);
    CHECK(find_force_on_held(world, Entity{}).norm() == 0);
}

TEST_CASE("what is held feels all other molecules, wherever it stands in the table",
          "[simulation][held]") {
    const std::size_t number = GENERATE(0, 1, 2);
    World world = test::three_waters(number, {1, 2.5, 1});
    move_grabbed(world, 2.9);
    const AtomTable& atoms = world.resource<AtomTable>();

    const FieldSum all = field_on_held(world, hand_at(world, 0));

    const auto field_of = [&](const char* name) {
        return evaluate_pair_field(points_of(atoms, test::range_called(world, "moved")),
                                   points_of(atoms, test::range_called(world, name)),
                                   pair_rule(world));
    };
    const FieldSum fixed = field_of("fixed"), third = field_of("third");
    // Neither is little beside the other.
    REQUIRE(fixed.force.norm() > 0.1 * third.force.norm());
    REQUIRE(third.force.norm() > 0.1 * fixed.force.norm());
    constexpr double rounding = 1e-12;
    CHECK(all.van_der_waals == Approx(fixed.van_der_waals + third.van_der_waals).epsilon(rounding));
    CHECK(all.electrostatic == Approx(fixed.electrostatic + third.electrostatic).epsilon(rounding));
    CHECK(all.force.isApprox(fixed.force + third.force, rounding));
    CHECK(all.torque.isApprox(fixed.torque + third.torque, rounding));
    CHECK(all.stiffness.isApprox(fixed.stiffness + third.stiffness, rounding));
    CHECK(force_along_line(world).force == Approx(all.force.x()).epsilon(rounding));
}
