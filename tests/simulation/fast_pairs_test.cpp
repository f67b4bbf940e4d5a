// Steps of a large rigid molecule have its pairs in single precision: against the same in double.
#include "core/units.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/step.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr double piconewton = units::piconewton_per_kcal_per_mol_angstrom;
constexpr double newton_per_metre = units::newton_per_metre_per_kcal_per_mol_angstrom2;

SceneDescription hiv(const std::string& file, const std::vector<std::string>& settings = {}) {
    return read_scene(test::in_project("scenes/hiv/" + file), settings);
}

// A relative part, since single precision has 6e-8, of which r^-12 makes some 1e-6, and of what is
// left of 400,000 electrostatic pairs that cancel an absolute one: 0.01 pN are felt as 4 µN here.
void check_against_double(const World& world, Entity hand) {
    const FieldSum fast = fast_field_on_held(world, hand), exact = field_on_held(world, hand);
    const Vec3 centre = centre_of_mass(world.resource<AtomTable>(), held_range(world, hand));
    const double force = piconewton * exact.force.norm();
    const Vec3 torque = piconewton * exact.torque_about(centre);  // pN Å
    const double stiffest = Eigen::SelfAdjointEigenSolver<Mat3>(newton_per_metre * exact.stiffness)
                                .eigenvalues()
                                .cwiseAbs()
                                .maxCoeff();
    constexpr double share = 5e-6;
    INFO(force << " pN, " << stiffest << " N/m, " << exact.energy() << " kcal/mol");

    CHECK(std::abs(fast.van_der_waals - exact.van_der_waals) <
          1e-3 + share * std::abs(exact.van_der_waals));
    CHECK(std::abs(fast.electrostatic - exact.electrostatic) <
          1e-3 + share * std::abs(exact.electrostatic));
    CHECK(piconewton * (fast.force - exact.force).norm() < 0.01 + share * force);
    CHECK((piconewton * fast.torque_about(centre) - torque).norm() < 0.1 + share * torque.norm());
    CHECK(newton_per_metre * (fast.stiffness - exact.stiffness).norm() < 1e-3 + share * stiffest);
}

}  // namespace

TEST_CASE("fast pairs on TL-3 are those in double, in contact, through atoms and far away",
          "[simulation][hiv][fast-pairs]") {
    World world = load_world(hiv(GENERATE("scene.toml", "charged/scene.toml", "surface.toml")));
    const Entity hand = hand_at(world, 0);
    REQUIRE(has_fast_pairs(world, hand));
    const MoleculePose start = grip_of(world, hand).pose;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto within = [&](double reach) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        return Vec3(reach * Vec3(x, y, z));
    };

    std::size_t different = 0;
    for (const auto& [angstrom, radian] :
         {std::array{0.3, 0.05}, {1.0, 0.3}, {5.0, 3.0}, {60.0, 3.0}, {1000.0, 3.0}}) {
        for (int pose = 0; pose < 20; ++pose) {
            INFO("pose " << pose << " within " << angstrom << " Å");
            const Vec3 turn = within(radian);
            const Quat turned(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
            place_grabbed(
                world,
                MoleculePose{start.place_angstrom + within(angstrom), turned * start.orientation},
                hand);

            check_against_double(world, hand);
            if (fast_field_on_held(world, hand).force != field_on_held(world, hand).force)
                ++different;
        }
    }
    CHECK(different >= 40);  // else double was compared with double
}

TEST_CASE("a step says what fast pairs say, or those in double where the scene wants them",
          "[simulation][hiv][fast-pairs]") {
    const bool is_fast = GENERATE(true, false);
    const std::string mode = GENERATE("guarded", "4");
    World world = load_world(test::with_held_at(
        GENERATE(0, 1, 2),
        hiv("scene.toml",
            {is_fast ? "statics.pairs=fast" : "statics.pairs=double", "coupling.mode=" + mode})));
    const Entity hand = hand_at(world, 0);
    HandPose pose;
    pose.molecule = grip_of(world, hand).pose;
    pose.molecule->place_angstrom += Vec3(0.1, -0.05, 0.08);
    REQUIRE(step_world(world, pose, contact_at(world, 0).model).finite);

    REQUIRE(has_fast_pairs(world, hand) == is_fast);
    const ContactModel& model = contact_at(world, 0).model;
    const FieldSum expected =
        is_fast ? fast_field_on_held(world, hand) : field_on_held(world, hand);
    const Vec3 force = expected.force * units::newton_per_kcal_per_mol_angstrom;
    CHECK((model.force_newton - force).norm() < 1e-14 * force.norm());
    CHECK(model.potential_kcal_per_mol == expected.energy());
    CHECK((fast_field_on_held(world, hand).force == field_on_held(world, hand).force) != is_fast);
    check_against_double(world, hand);
    // A copy says the same.
    const World copy = world;
    CHECK(fast_field_on_held(copy, hand).force == fast_field_on_held(world, hand).force);
}

TEST_CASE("two hands with rigid molecules in them have fast pairs, before and after an edit",
          "[simulation][hiv][second][fast-pairs]") {
    World world = load_world(hiv(
        "scene.toml", {"molecules.protease_b.motion=translate", "second.grab.molecule=protease_b",
                       "second.grab.measured_from=protease_a", "second.hand.grip=medium"}));
    const std::vector<Entity> hands = find_hands(world);
    REQUIRE(hands.size() == 2);
    std::array<HandPose, 2> poses;
    std::array<ContactModel, 2> felt;
    for (std::size_t i = 0; i < 2; ++i) {
        poses[i].molecule = grip_of(world, hands[i]).pose;
        poses[i].molecule->place_angstrom += Vec3(0.1, 0.2 * static_cast<double>(i), 0);
        felt[i] = contact_of(world, hands[i]).sent.model;
    }
    REQUIRE(step_world(world, {poses, felt}).finite);

    for (const Entity hand : hands) {
        REQUIRE(has_fast_pairs(world, hand));
        check_against_double(world, hand);
    }

    ReleaseEdit{}.apply(world, 1);
    RemoveEdit{.molecule = "protease_b"}.apply(world, 0);
    REQUIRE(has_fast_pairs(world, hands[0]));
    check_against_double(world, hands[0]);
}

TEST_CASE("few pairs are in double, whatever the scene says", "[simulation][fast-pairs]") {
    const World world = load_world(test::water_scene({"statics.pairs=fast"}));
    const Entity hand = hand_at(world, 0);

    CHECK_FALSE(has_fast_pairs(world, hand));
    CHECK(fast_field_on_held(world, hand).force == field_on_held(world, hand).force);
    CHECK(fast_field_on_held(world, hand).energy() == field_on_held(world, hand).energy());
}
