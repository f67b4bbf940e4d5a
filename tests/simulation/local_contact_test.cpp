// How much of what a frozen environment foretold came true. The environment is made to follow the
// molecule by a known share of its move, so what comes is the rest.
#include "simulation/systems/publish_contact.h"

#include "core/units.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/step.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

LocalContactModel& write_local_contact(World& world) {
    return world.write<Contact>(hand_at(world, 0))->sent;
}

constexpr double dimer_distance = 2.6, dimer_step = 0.002;  // Å; the force is steep there

// The guarded dimer, with a contact model of where it stands.
World dimer() {
    World world = load_world(test::water_scene({"mode=guarded"}));
    move_grabbed(world, dimer_distance);
    write_local_contact(world) = build_local_contact(world, hand_at(world, 0), {});
    return world;
}

// The molecule goes in by a step, and everything else by `followed` of that.
void step_in(World& world, double followed) {
    const Vec3 place = grabbed_place(world);
    for (const std::uint32_t i : test::atoms_around(world))
        world.write<AtomTable>().positions[i].x() -= followed * dimer_step;
    move_grabbed(world, grabbed_distance(world) - dimer_step);
    REQUIRE((grabbed_place(world) - place).norm() == Approx(dimer_step));
    update_contact(world, hand_at(world, 0), {});
}

double newton_at(const World& world, double at) {
    return force_along_line_at(world, at).force * units::newton_per_kcal_per_mol_angstrom;
}

}  // namespace

TEST_CASE("half of the way to what came true is gone in each step", "[simulation][contact]") {
    const double followed = GENERATE(0.0, 0.3, 0.8, 1.0);
    World world = dimer();

    // 1/2 (1 + share), then halfway on again. Forces bend by less than a hundredth on the way.
    const double share = 1 - followed;
    step_in(world, followed);
    CHECK(contact_at(world, 0).model.prediction_gain == Approx(0.5 + 0.5 * share).margin(0.01));
    step_in(world, followed);
    CHECK(contact_at(world, 0).model.prediction_gain == Approx(0.25 + 0.75 * share).margin(0.01));
    // Whoever sees that the environment moves does not trust its field far away.
    CHECK(contact_at(world, 0).model.is_compliant == (followed > 0));
}

TEST_CASE("more than was foretold counts as all, and the opposite as nothing",
          "[simulation][contact]") {
    World world = dimer();
    step_in(world, -2);  // the environment comes towards the molecule
    CHECK(contact_at(world, 0).model.prediction_gain == 1);

    world = dimer();
    step_in(world, 3);  // it flees, so the force falls instead of rising
    CHECK(contact_at(world, 0).model.prediction_gain == Approx(0.5));
}

TEST_CASE("what was foretold less than 2 pN of confirms and denies nothing",
          "[simulation][contact]") {
    World world = load_world(test::water_scene({"mode=guarded"}));
    const double far = GENERATE(4.0, 12.0);
    move_grabbed(world, far);
    write_local_contact(world) = build_local_contact(world, hand_at(world, 0), {});
    write_local_contact(world).model.prediction_gain = 0.6;
    const bool is_foretold = std::abs(newton_at(world, far - 0.2) - newton_at(world, far)) > 2e-12;
    REQUIRE(is_foretold == (far == 4));

    move_grabbed(world, far - 0.2);
    update_contact(world, hand_at(world, 0), {});

    CHECK(contact_at(world, 0).model.prediction_gain ==
          Approx(is_foretold ? 0.8 : 0.6).margin(1e-3));
}

TEST_CASE("a contact without atoms keeps the prediction gain", "[simulation][contact]") {
    World world = dimer();
    write_local_contact(world).model.prediction_gain = 0.6;
    write_local_contact(world).model.torque_prediction_gain = 0.7;
    write_local_contact(world).field.has_atoms = false;

    step_in(world, 1);

    CHECK(contact_at(world, 0).model.prediction_gain == 0.6);
    CHECK(contact_at(world, 0).model.torque_prediction_gain == 0.7);
}

TEST_CASE("torques are confirmed by themselves", "[simulation][contact]") {
    const double followed = GENERATE(0.0, 0.4, 1.0);
    constexpr double turn = 0.05;  // rad
    World world = dimer();
    const Vec3 pivot = grabbed_place(world);
    const auto about = [&](double angle) {
        return Eigen::AngleAxisd(angle, Vec3(0.3, 1, -0.5).normalized());
    };

    for (const std::uint32_t i : test::atoms_around(world)) {
        Vec3& place = world.write<AtomTable>().positions[i];
        place = pivot + about(followed * turn) * (place - pivot);
    }
    for (const std::uint32_t i : held_atoms(world, hand_at(world, 0))) {
        Vec3& place = world.write<AtomTable>().positions[i];
        place = pivot + about(turn) * (place - pivot);
    }
    update_contact(world, hand_at(world, 0), {});

    CHECK(contact_at(world, 0).model.torque_prediction_gain ==
          Approx(1 - 0.5 * followed).margin(0.03));
}

TEST_CASE("the servo gets the nearest atoms of others, wherever what is held stands in the table",
          "[simulation][contact]") {
    constexpr std::size_t own = 130, most = 400;
    const std::size_t number = GENERATE(0, 1, 2);
    const SceneDescription scene = read_scene(
        test::in_project("scenes/hiv"),
        std::vector<std::string>{"mode=guarded", fmt::format("pairs_per_tick={}", own * most)});
    World world = load_world(test::with_held_at(number, scene));
    const Entity hand = hand_at(world, 0);
    const AtomRange held = test::range_called(world, "inhibitor");
    REQUIRE(held.count == own);
    const std::vector<Vec3> before = world.resource<AtomTable>().positions;

    // Far enough for atoms to be chosen anew.
    HandPose pose;
    pose.molecule = grip_of(world, hand).pose;
    pose.molecule->place_angstrom.x() += 0.6;
    REQUIRE(step_world(world, pose, contact_at(world, 0).model).finite);

    const std::vector<Vec3>& places = world.resource<AtomTable>().positions;
    REQUIRE((places[held.first] - before[held.first]).norm() > 0.5);
    std::vector<std::pair<double, std::uint32_t>> by_distance;
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        if (has_atom(held, i)) continue;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::uint32_t k = held.first; k < held.first + own; ++k)
            nearest = std::min(nearest, (places[i] - places[k]).norm());
        by_distance.emplace_back(nearest, i);
    }
    std::ranges::sort(by_distance);
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < most; ++i) expected.push_back(by_distance[i].second);
    std::ranges::sort(expected);
    CHECK(contact_of(world, hand).near.atoms == expected);
    const std::vector<Vec3>& frozen = contact_at(world, 0).field.frozen.environment.positions;
    REQUIRE(frozen.size() == most);
    for (std::size_t i = 0; i < most; ++i) CHECK(frozen[i] == places[expected[i]]);
}

TEST_CASE("of few atoms the servo gets all of others, wherever what is held stands in the table",
          "[simulation][contact]") {
    const std::size_t number = GENERATE(0, 1, 2);
    World world = test::three_waters(number, {1, 2.5, 1}, {"mode=guarded"});
    move_grabbed(world, 2.9);

    const auto check_field = [&] {
        const LocalField field = build_local_contact(world, hand_at(world, 0), {}).field;
        CHECK(field.frozen.environment.positions.size() == 6);
        CHECK(field.group.front() == grabbed_place(world));
        const Vec3 force = field_on_grabbed(world).force;
        CHECK((field.at_step.force - force).norm() < 1e-5 * force.norm());
    };
    check_field();
    update_contact(world, hand_at(world, 0), {});
    CHECK(contact_of(world, hand_at(world, 0)).near.atoms == test::atoms_around(world));
    check_field();
}
