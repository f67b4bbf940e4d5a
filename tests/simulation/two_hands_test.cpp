// Two hands in one world, against worlds in which one hand put the same molecules there.
#include "core/units.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;

namespace {

SceneDescription two_waters(const std::vector<std::string>& settings = {}) {
    return read_scene(test::in_project("scenes/water/two-hands.toml"), settings);
}

std::array<Entity, 2> hands_of(const World& world) {
    const std::vector<Entity> hands = find_hands(world);
    REQUIRE(hands.size() == 2);
    return {hands[0], hands[1]};
}

using Poses = std::array<MoleculePose, 2>;

Poses poses_of(const World& world) {
    const auto [first, second] = hands_of(world);
    return {grip_of(world, first).pose, grip_of(world, second).pose};
}

// The servo has put what hands hold there.
void step_to(World& world, const Poses& poses) {
    std::array<HandPose, 2> hands;
    std::array<ContactModel, 2> felt;
    for (std::size_t i = 0; i < 2; ++i) {
        hands[i].molecule = poses[i];
        felt[i] = contact_of(world, hands_of(world)[i]).sent.model;
    }
    REQUIRE(step_world(world, {hands, felt}).finite);
}

// A world in which only this hand holds something; what the other one held stands still where that
// has it.
World one_hand(const World& two, SceneDescription scene, std::size_t slot) {
    const std::string still = scene.hands[1 - slot].grab.molecule;
    for (MoleculeDescription& molecule : scene.molecules) {
        if (molecule.name == still) molecule.motion = Motion::Fixed;
    }
    scene.hands = {scene.hands[slot]};
    World world = load_world(scene);
    const auto range_of = [&](const World& of) {
        return of.find<Molecule>(molecule_called(of, still))->atoms;
    };
    const AtomRange from = range_of(two), to = range_of(world);
    REQUIRE(from.count == to.count);
    std::copy_n(two.resource<AtomTable>().positions.begin() + from.first, from.count,
                world.write<AtomTable>().positions.begin() + to.first);
    return world;
}

double relative(const Vec3& value, const Vec3& expected) {
    return (value - expected).norm() / expected.norm();
}

}  // namespace

TEST_CASE("two hands feel what one feels with the molecules where they have them",
          "[simulation][second]") {
    const SceneDescription scene =
        two_waters({GENERATE("coupling.mode=guarded", "coupling.mode=\"4\"")});
    World two = load_world(scene);
    Poses poses = poses_of(two);
    poses[0].place_angstrom += Vec3(1.4, 0.3, -0.2);
    poses[1].place_angstrom += Vec3(-1.1, -0.1, 0.4);

    step_to(two, poses);

    for (std::size_t slot = 0; slot < 2; ++slot) {
        INFO("hand " << slot);
        World one = one_hand(two, scene, slot);
        const ContactModel& felt = contact_of(two, hands_of(two)[slot]).sent.model;
        const HandPose hand{.molecule =
                                MoleculePose{poses[slot].place_angstrom,
                                             grip_of(one, hand_at(one, 0)).pose.orientation}};
        // Relaxed beside another neighbour, it would be turned elsewhere.
        const AtomRange own = held_range(two, hands_of(two)[slot]);
        const AtomRange same = held_range(one, hand_at(one, 0));
        RigidShape& shape = *one.write<RigidShape>(grip_of(one, hand_at(one, 0)).molecule);
        const Vec3 reference = two.resource<AtomTable>().positions[own.first];
        for (std::size_t i = 0; i < same.count; ++i)
            shape.atoms[i] = two.resource<AtomTable>().positions[own.first + i] - reference;
        REQUIRE(step_world(one, hand, contact_at(one, 0).model).finite);
        const ContactModel& expected = contact_at(one, 0).model;

        REQUIRE(expected.force_newton.norm() > 50e-12);
        CHECK(relative(felt.force_newton, expected.force_newton) < 1e-12);
        CHECK(relative(felt.torque_newton_metre, expected.torque_newton_metre) < 1e-12);
        CHECK(felt.potential_kcal_per_mol ==
              Approx(expected.potential_kcal_per_mol).epsilon(1e-12));
        const Mat3 stiffer = felt.stiffness_matrix_N_per_m - expected.stiffness_matrix_N_per_m;
        CHECK(stiffer.norm() < 1e-12 * expected.stiffness_matrix_N_per_m.norm());
    }
}

TEST_CASE("between steps a hand feels the other's molecule where its servo has it by then",
          "[simulation][second]") {
    World world = load_world(two_waters());
    Poses poses = poses_of(world);
    poses[0].place_angstrom.x() += 1.3;
    poses[1].place_angstrom.x() -= 1.3;
    step_to(world, poses);
    std::array<LocalContactModel, 2> contacts;
    for (std::size_t i = 0; i < 2; ++i) contacts[i] = contact_of(world, hands_of(world)[i]).sent;

    Poses later = poses;
    later[0].place_angstrom += Vec3(0.2, 0.1, 0);
    later[1].place_angstrom += Vec3(0.1, -0.2, 0.1);
    step_to(world, later);

    const std::array<std::optional<LiveMolecule>, 2> live{LiveMolecule{later[0]},
                                                          LiveMolecule{later[1]}};
    for (std::size_t i = 0; i < 2; ++i) {
        const LocalContactModel& contact = contacts[i];
        REQUIRE(contact.field.has_atoms);
        REQUIRE(contact.field.held.size() == 1);
        CHECK(contact.field.held[0].hand == 1 - i);
        // The one that stands still, and the one that the other hand moves: none twice.
        CHECK(contact.field.frozen.environment.positions.size() == 3);
        CHECK(contact.field.held[0].frozen.environment.positions.size() == 3);
        const Vec3 foretold =
            evaluate_local(contact.model, contact.field, later[i], live).force_newton;
        const Vec3 came = contact_of(world, hands_of(world)[i]).sent.model.force_newton;
        REQUIRE(relative(contact.model.force_newton, came) > 0.05);
        CHECK(relative(foretold, came) < 1e-5);
        // Nothing gives way: all that was foretold came.
        CHECK(contact_of(world, hands_of(world)[i]).sent.model.prediction_gain ==
              Approx(1).margin(1e-4));
        CHECK_FALSE(contact_of(world, hands_of(world)[i]).sent.model.is_compliant);
    }
}

TEST_CASE("what both hands move together was foretold to feel the same", "[simulation][second]") {
    World world = load_world(two_waters());
    Poses poses = poses_of(world);
    poses[0].place_angstrom.x() += 1.4;
    poses[1].place_angstrom.x() -= 1.4;
    step_to(world, poses);
    for (int i = 0; i < 5; ++i) {
        for (MoleculePose& pose : poses) pose.place_angstrom.x() += 0.1;
        step_to(world, poses);
    }
    // With a field that left the other where it was, it would be 1/2^5.
    for (const Entity hand : hands_of(world))
        CHECK(contact_of(world, hand).sent.model.prediction_gain > 0.95);
}

TEST_CASE("hands without a pose of their own stand still", "[simulation][second]") {
    World world = load_world(two_waters());
    const Poses poses = poses_of(world);
    HandPose first;
    first.molecule = poses[0];
    first.molecule->place_angstrom.x() += 0.5;

    REQUIRE(step_world(world, first, contact_at(world, 0).model).finite);

    CHECK(poses_of(world)[0].place_angstrom == first.molecule->place_angstrom);
    CHECK(poses_of(world)[1].place_angstrom == poses[1].place_angstrom);
}

TEST_CASE("of two molecules in hand that turn by themselves each hand is pulled at by all others",
          "[simulation][second]") {
    World world = load_world(two_waters({"molecules.left.motion=translate-and-turn",
                                         "molecules.right.motion=translate-and-turn",
                                         "statics.pairs=double", "statics.method=quasi-static"}));
    Poses poses = poses_of(world);
    for (int i = 0; i < 5; ++i) {
        poses[0].place_angstrom += Vec3(0.1, 0.02, 0);
        poses[1].place_angstrom += Vec3(-0.1, 0, 0.03);
        step_to(world, poses);
    }
    for (const Entity hand : hands_of(world)) {
        const Vec3 force = find_pull_on_held(world, hand).tail<3>();
        const Vec3 expected = field_on_held(world, hand).force;
        REQUIRE(expected.norm() > 0.5);
        CHECK(relative(force, expected) < 1e-12);
        CHECK(relative(contact_of(world, hand).sent.model.force_newton,
                       units::newton_per_kcal_per_mol_angstrom * expected) < 1e-12);
    }
}

TEST_CASE("two hands pull at one molecule by two springs", "[simulation][second]") {
    World world = load_world(
        two_waters({"molecules.left.motion=free", "molecules.right.motion=fixed", "grab.atom=1 H1",
                    "second.grab.molecule=left", "second.grab.atom=1 H2"}));
    const auto [first, second] = hands_of(world);
    REQUIRE(world.resource<TorsionState>().springs.size() == 2);
    CHECK(spring_of(world, first)->atoms != spring_of(world, second)->atoms);
    const auto length = [&](Entity hand) {
        const ModelSpring& spring = *spring_of(world, hand);
        return (spring.place - world.resource<AtomTable>().positions[spring.atoms[0]]).norm();
    };
    Poses poses = poses_of(world);
    const double apart = (held_place(world, first) - held_place(world, second)).norm();
    // Pulled apart the molecule hangs between them, each spring as long as half of what is too
    // much.
    const Vec3 axis = (held_place(world, second) - held_place(world, first)).normalized();
    for (int i = 0; i < 400; ++i) {
        if (i < 20) {
            poses[0].place_angstrom -= 0.05 * axis;
            poses[1].place_angstrom += 0.05 * axis;
        }
        step_to(world, poses);
    }
    const double now = (held_place(world, first) - held_place(world, second)).norm();
    const double between = 2 * 0.9572 * std::sin(0.5 * 104.52 * std::numbers::pi / 180);
    CHECK(now > apart + 1.5);
    // What pulls at a hand is its own spring.
    for (const Entity hand : {first, second}) {
        const ModelSpring& spring = *spring_of(world, hand);
        const Vec3 stretch = world.resource<AtomTable>().positions[spring.atoms[0]] - spring.place;
        CHECK(relative(find_force_on_held(world, hand), spring.k * stretch) < 1e-9);
    }
    CHECK(length(first) + length(second) == Approx(now - between).margin(0.1));
    CHECK(length(first) == Approx(length(second)).margin(0.15));
}

TEST_CASE("one hand holds a molecule as a whole, the other pulls at it by a spring",
          "[simulation][second]") {
    World world = load_world(
        two_waters({"molecules.left.motion=translate-and-turn", "molecules.right.motion=fixed",
                    "second.grab.molecule=left", "second.grab.atom=1 H2"}));
    const auto [first, second] = hands_of(world);
    CHECK(spring_of(world, first) == nullptr);
    REQUIRE(spring_of(world, second) != nullptr);
    const Vec3 before = held_place(world, first);
    const std::uint32_t atom = spring_of(world, second)->atoms[0];
    Poses poses = poses_of(world);
    for (int i = 0; i < 300; ++i) {
        if (i < 20) poses[1].place_angstrom.z() -= 0.05;
        step_to(world, poses);
    }
    // It turns to the spring about where the first hand keeps it.
    CHECK((held_place(world, first) - before).norm() < 1e-9);
    const Vec3 arm = world.resource<AtomTable>().positions[atom] - before;
    const Vec3 drawn = held_place(world, second) - before;
    CHECK(arm.normalized().dot(drawn.normalized()) > 0.98);
}

TEST_CASE("what two hands cannot hold is told at its place", "[simulation][second][errors]") {
    const auto error_of = [](const std::vector<std::string>& settings) {
        return test::load_error_of([&] { (void)load_world(two_waters(settings)); });
    };
    CHECK_THAT(error_of({"second.grab.molecule=left", "molecules.right.motion=fixed"}),
               Contains("--set second.grab.molecule=left") &&
                   Contains("two hands hold 'left' as a whole"));
    CHECK_THAT(
        error_of({"second.grab.measured_from=left"}),
        Contains("--set second.grab.measured_from=left") && Contains("expected a fixed molecule"));
    CHECK_THAT(error_of({"grab.measured_from=right"}),
               Contains("--set grab.measured_from=right") && Contains("expected a fixed molecule"));
    CHECK_THAT(error_of({"molecules.right.motion=free", "second.grab.atom=7 CA"}),
               Contains("--set second.grab.atom=7 CA") && Contains("'right' has no atom"));
    CHECK_THAT(error_of({"second.hand.start_offset_angstrom=[1000, 0, 0]"}),
               Contains("'right' and 'standing' are"));
}

TEST_CASE(
    "flexible molecules that one hand moves and another pulls at by a spring do what they do "
    "in one hand, with a restraint for the other",
    "[simulation][second]") {
    const auto load = [](std::vector<std::string> settings) {
        settings.emplace_back("statics.steps=5");
        return load_world(read_scene(test::test_data("two_peptides"), settings));
    };
    const double k = 12;
    World two = load({"second.grab.molecule=resting", "second.grab.measured_from=resting",
                      "second.grab.atom=3 CB", "second.grab.spring_kcal_per_mol_angstrom2=12"});
    const auto [first, second] = hands_of(two);
    World one = load({});
    const Vec3 end = held_place(two, second);
    RestraintEdit{{"resting:3 CB"}, {{end.x(), end.y(), end.z()}}, k, 0}.apply(one, 0);
    const std::uint32_t atom = spring_of(two, second)->atoms.front();
    Poses poses = poses_of(two);
    // What both round differently grows tenfold in some steps.
    for (int i = 0; i < 15; ++i) {
        INFO("step " << i);
        poses[0].place_angstrom += Vec3(-0.1, 0.02, 0.04);
        poses[1].place_angstrom += Vec3(0.04, 0.1, -0.06);
        step_to(two, poses);
        one.write_each<Spring>([&, place = spring_of(two, second)->place](Entity, Spring& spring) {
            spring.place = place;
        });
        HandPose hand;
        hand.molecule = poses[0];
        REQUIRE(step_world(one, hand, contact_at(one, 0).model).finite);

        const ContactModel& felt = contact_of(two, first).sent.model;
        const ContactModel& expected = contact_at(one, 0).model;
        CHECK(relative(felt.force_newton, expected.force_newton) < 1e-8);
        CHECK(relative(felt.torque_newton_metre, expected.torque_newton_metre) < 1e-8);
        CHECK(felt.potential_kcal_per_mol ==
              Approx(expected.potential_kcal_per_mol).epsilon(1e-8).margin(1e-9));
        // The other hand feels its spring, and as much as the restraint.
        const Vec3 stretch =
            one.resource<AtomTable>().positions[atom] - spring_of(two, second)->place;
        CHECK(relative(contact_of(two, second).sent.model.force_newton,
                       k * units::newton_per_kcal_per_mol_angstrom * stretch) < 1e-8);
    }
    CHECK(contact_of(two, second).sent.model.force_newton.norm() > 20e-12);
    CHECK(contact_of(two, first).sent.model.force_newton.norm() > 20e-12);
}
