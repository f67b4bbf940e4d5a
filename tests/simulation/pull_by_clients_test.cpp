// Forces of clients, against Hooke's law of the springs that hold what they pull.
#include "simulation/systems/pull_by_clients.h"
#include "session/undo_history.h"
#include "simulation/solver.h"

#include "core/units.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "simulation/client_pull.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/pull_molecule.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

using namespace palpa;

namespace {

AtomRange atoms_of_water(const World& world, const std::string& name) {
    return world.find<Molecule>(molecule_called(world, name))->atoms;
}

Vec3 centre_of_water(const World& world, const std::string& name) {
    return centre_of_mass(world.resource<AtomTable>(), atoms_of_water(world, name));
}

// A water that moves by itself, 60 Å from the scene's two.
World water_to_be_pulled(const std::string& method) {
    World world = load_world(test::water_scene({"mode=4", "statics.method=" + method}));
    AddEdit{"TIP3", "", "free", {0, 0, 60}}.apply(world, 0);
    MobilityEdit{"free", Motion::Free, {}}.apply(world, 0);
    return world;
}

void restrain(World& world, double k) {
    const Vec3 at = centre_of_water(world, "free");
    RestraintEdit{{"free:1"}, {{at.x(), at.y(), at.z()}}, k, 0}.apply(world, 0);
}

ClientPull pull_at(const World& world, const std::string& name, const Vec3& force) {
    return test::pull_molecule(world, molecule_called(world, name), force);
}

void step_on(World& world, int steps) {
    for (int i = 0; i < steps; ++i)
        REQUIRE(step_world(world, HandPose{}, contact_at(world, 0).model).finite);
}

}  // namespace

TEST_CASE("a client moves a water until its restraint pulls as hard, and lets it go back",
          "[clients]") {
    const std::string method = GENERATE(as<std::string>(), "quasi-static", "second-order");
    CAPTURE(method);
    constexpr double margin = 0.03;  // Å
    World world = water_to_be_pulled(method);
    restrain(world, 2);
    step_on(world, 100);
    const Vec3 start = centre_of_water(world, "free"), fixed = centre_of_water(world, "fixed");
    const double energy = find_energy(world);
    CHECK_FALSE(is_pulled_by_clients(world));

    world.set_resource(pull_at(world, "free", {3, 0, -1}));
    step_on(world, 600);
    CHECK(is_pulled_by_clients(world));
    CHECK(count_pulls_without_effect(world) == 0);
    const Vec3 moved = centre_of_water(world, "free") - start;
    CHECK(moved.x() == Approx(1.5).margin(margin));
    CHECK(moved.z() == Approx(-0.5).margin(margin));
    CHECK(std::abs(moved.y()) < 0.02);
    // The restraint's alone: k x^2/2.
    CHECK(find_energy(world) - energy == Approx(moved.squaredNorm()).epsilon(0.02));
    CHECK(find_client_energy(world) > 100);
    CHECK(centre_of_water(world, "fixed") == fixed);

    world.set_resource(ClientPull{{}, {}, world.resource<AtomTable>().size()});
    step_on(world, 600);
    CHECK_FALSE(is_pulled_by_clients(world));
    CHECK((centre_of_water(world, "free") - start).norm() < margin);
    CHECK(find_client_energy(world) == 0);
}

TEST_CASE("a force of a client stays what it is however far its atom goes", "[clients]") {
    const std::string method = GENERATE("quasi-static", "second-order");
    CAPTURE(method);
    World world = water_to_be_pulled(method);
    const Vec3 start = centre_of_water(world, "free"), force(0, 0, 2);
    world.set_resource(pull_at(world, "free", force));
    const double slack = method == std::string("second-order") ? 0.02 : 0;
    double last = start.z();
    for (int i = 0; i < 300; ++i) {
        step_on(world, 1);
        const double z = centre_of_water(world, "free").z();
        CHECK(z >= last);
        const TorsionState& state = world.resource<TorsionState>();
        Vec3 sum = Vec3::Zero();
        for (const ModelSpring& spring : state.springs)
            sum += find_spring_force(model_of(world), spring, state.positions);
        // This step has moved it since the ends were placed, 100 Å before it.
        CHECK((sum + force).norm() < (slack + (z - last) / 100 + 1e-3) * force.norm());
        last = z;
    }
    CHECK(last > start.z() + 3);
}

TEST_CASE("a hand on a spring feels what a client pulls with", "[clients]") {
    World world = water_to_be_pulled("quasi-static");
    restrain(world, 0.001);
    GrabEdit{"free:1"}.apply(world, 0);
    step_on(world, 100);
    const Vec3 end = held_place(world, hand_at(world, 0));
    world.set_resource(pull_at(world, "free", {0, 3, 0}));
    step_on(world, 600);
    CHECK(held_place(world, hand_at(world, 0)) == end);
    const Vec3 felt =
        contact_at(world, 0).model.force_newton / units::newton_per_kcal_per_mol_angstrom;
    CHECK(felt.y() == Approx(3).epsilon(0.02));
    CHECK(std::abs(felt.x()) < 0.05);
}

TEST_CASE("forces on what cannot move by itself do nothing, and are counted", "[clients]") {
    const std::string method = GENERATE("quasi-static", "second-order");
    World world = water_to_be_pulled(method);
    step_on(world, 5);
    const Vec3 fixed = centre_of_water(world, "fixed"), held = centre_of_water(world, "moved");
    const std::string name = GENERATE("fixed", "moved");
    world.set_resource(pull_at(world, name, {30, 0, 0}));
    step_on(world, 50);
    CHECK(centre_of_water(world, "fixed") == fixed);
    CHECK((centre_of_water(world, "moved") - held).norm() < 1e-9);
    CHECK(count_pulls_without_effect(world) == 3);
    CHECK_FALSE(is_pulled_by_clients(world));
}

TEST_CASE("a world in which nothing moves by itself is not pulled", "[clients]") {
    World world = load_world(test::water_scene());
    World other = world;
    world.set_resource(pull_at(world, "fixed", {30, 0, 0}));
    step_on(world, 5);
    step_on(other, 5);
    CHECK(world.resource<AtomTable>().positions == other.resource<AtomTable>().positions);
    CHECK(count_pulls_without_effect(world) == 3);
}

TEST_CASE("where atoms are others than the client knows nothing is pulled", "[clients]") {
    World world = water_to_be_pulled("quasi-static");
    world.set_resource(pull_at(world, "free", {3, 0, 0}));
    step_on(world, 2);
    CHECK(is_pulled_by_clients(world));
    AddEdit{"TIP3", "", "other", {0, 30, 60}}.apply(world, 0);
    step_on(world, 2);
    CHECK_FALSE(is_pulled_by_clients(world));
    CHECK(count_pulls_without_effect(world) == 3);
    world.set_resource(pull_at(world, "free", {3, 0, 0}));
    step_on(world, 2);
    CHECK(is_pulled_by_clients(world));
}

TEST_CASE("undo and edits find the springs of hands and restraints in their place", "[clients]") {
    World world = water_to_be_pulled("second-order");
    restrain(world, 2);
    const ClientPull pull = pull_at(world, "free", {3, 0, 0});
    world.set_resource(pull);
    step_on(world, 100);
    const Vec3 pulled = centre_of_water(world, "free");
    UndoHistory history;
    history.apply(world, {0, 0, GrabEdit{"free:1"}, {"test", 1, 0}});
    REQUIRE(spring_of(world, hand_at(world, 0)));
    step_on(world, 50);
    CHECK(world.resource<TorsionState>().springs.size() == 2 + 3);
    CHECK(spring_of(world, hand_at(world, 0))->atoms.size() == 3);
    CHECK((centre_of_water(world, "free") - pulled).norm() < 0.05);
    history.apply(world, {0, 0, UndoEdit{}, {"test", 1, 0}});
    world.set_resource(pull);
    step_on(world, 50);
    CHECK(world.resource<TorsionState>().springs.size() == 1 + 3);
    CHECK((centre_of_water(world, "free") - pulled).norm() < 0.05);
}
