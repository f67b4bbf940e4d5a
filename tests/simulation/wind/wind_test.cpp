// A system of 30 lines is one file and one line in the list of the step: this program has the
// engine's own step.cpp with that line.
#include "tests/simulation/wind/wind.h"
#include "session/undo_history.h"

#include "core/files.h"
#include "core/text.h"
#include "core/units.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/client_pull.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/resources.h"
#include "simulation/step.h"
#include "simulation/systems/gather_springs.h"
#include "simulation/systems/pull_by_clients.h"
#include "tests/support/paths.h"
#include "tests/support/pull_molecule.h"
#include "tests/support/water_scene.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;

namespace {

constexpr double wind = 0.5;  // kcal/mol/Å

// A water that moves by itself, far from the scene's two.
World water_in_the_wind() {
    World world = load_world(test::water_scene({"mode=4", "statics.method=quasi-static"}));
    AddEdit{"TIP3", "", "free", {0, 0, 60}}.apply(world, 0);
    MobilityEdit{"free", Motion::Free, {}}.apply(world, 0);
    return world;
}

Vec3 centre_of(const World& world, const std::string& molecule) {
    return centre_of_mass(world.resource<AtomTable>(),
                          world.find<Molecule>(molecule_called(world, molecule))->atoms);
}

void step(World& world, int steps) {
    for (int i = 0; i < steps; ++i)
        REQUIRE(step_world(world, HandPose{}, contact_at(world, 0).model).finite);
}

Entity add_free(World& world, const std::string& name, const std::array<double, 3>& place) {
    AddEdit{"TIP3", "", name, place}.apply(world, 0);
    MobilityEdit{name, Motion::Free, {}}.apply(world, 0);
    return molecule_called(world, name);
}

void step_both(World& world) {
    std::array<HandPose, 2> poses;
    std::array<ContactModel, 2> felt;
    REQUIRE(step_world(world, {poses, felt}).finite);
}

}  // namespace

TEST_CASE("the code that engine/README.md shows is what runs", "[wind]") {
    const auto text_of = [](const char* path) { return read_text_file(test::in_project(path)); };
    const std::string code =
        text_of("tests/simulation/wind/wind.cpp") + text_of("engine/simulation/step.cpp") +
        text_of("engine/app/panels/messages.cpp") + text_of("engine/app/actions.cpp") +
        text_of("engine/app/frame.cpp") + text_of("tests/simulation/CMakeLists.txt");
    const std::string readme = text_of("engine/README.md");
    bool is_code = false;
    int lines = 0;
    for (const std::string_view line : split_lines(readme)) {
        if (line.starts_with("```")) {
            is_code = line == "```cpp";
            continue;
        }
        if (!is_code) continue;
        INFO(line);
        CHECK(code.find(trimmed(line)) != std::string::npos);
        ++lines;
    }
    CHECK(lines > 13);
}

TEST_CASE("a free water drifts before the wind, others stay", "[wind]") {
    World world = water_in_the_wind();
    const Vec3 start = centre_of(world, "free"), fixed = centre_of(world, "fixed");
    double last = start.x();
    for (int i = 0; i < 20; ++i) {
        step(world, 5);
        CHECK(centre_of(world, "free").x() > last);
        last = centre_of(world, "free").x();
    }
    CHECK(last > start.x() + 0.2);
    CHECK((centre_of(world, "free") - start).tail<2>().norm() < 0.05 * (last - start.x()));
    CHECK(centre_of(world, "fixed") == fixed);
}

TEST_CASE("a water on a spring rests where the spring pulls as hard as the wind", "[wind]") {
    World world = water_in_the_wind();
    const Vec3 start = centre_of(world, "free");
    const double k = GENERATE(2.0, 5.0);
    RestraintEdit{{"free:1"}, {{start.x(), start.y(), start.z()}}, k, 0}.apply(world, 0);
    step(world, 400);
    const Vec3 moved = centre_of(world, "free") - start;
    // The two other waters, 60 Å away, pull with less than a hundredth of that.
    CHECK(moved.x() == Approx(wind / k).epsilon(0.02));
    CHECK(moved.tail<2>().norm() < 0.02 * wind / k);
}

TEST_CASE("in a hand there is no wind", "[wind]") {
    World world = water_in_the_wind();
    GrabEdit{"free"}.apply(world, 0);
    const Vec3 place = held_place(world, hand_at(world, 0));
    step(world, 20);
    CHECK((held_place(world, hand_at(world, 0)) - place).norm() < 1e-12);
    CHECK(contact_at(world, 0).model.force_newton.norm() <
          0.02 * wind * units::newton_per_kcal_per_mol_angstrom);
    ReleaseEdit{}.apply(world, 0);
    MobilityEdit{"free", Motion::Free, {}}.apply(world, 0);
    step(world, 20);
    CHECK(centre_of(world, "free").x() > place.x() + 0.01);
}

TEST_CASE("edits and undo find the wind as it was", "[wind]") {
    World world = water_in_the_wind();
    UndoHistory history;
    history.apply(world, {0, 0, AddEdit{"TIP3", "", "other", {0, 30, 60}}, {"wind", 1, 0}});
    step(world, 20);
    CHECK(centre_of(world, "other").x() > 0.01);
    history.apply(world, {0, 0, UndoEdit{}, {"wind", 1, 0}});
    const double before = centre_of(world, "free").x();
    step(world, 20);
    CHECK(centre_of(world, "free").x() > before + 0.01);
}

namespace {

// A component of the entity that owns the springs of a gust along y.
struct Gust {};

void blow_gust(World& world, Entity water, double force) {
    constexpr double k = 0.02;
    const Entity gust = make_owner<Gust>(world);
    for (const Entity spring : find_springs(world, gust)) world.destroy(spring);
    const AtomsOf atoms{water, all_atoms_of(world, water)};
    const Vec3 end = middle_of(world, atoms) + Vec3(0, force / k, 0);
    world.set(world.create(), Spring{{atoms}, end, k, 0, gust});
}

}  // namespace

TEST_CASE("two winds, a client and two hands pull at once, each with its own force", "[wind]") {
    const std::string method = GENERATE("quasi-static", "second-order");
    CAPTURE(method);
    const std::vector<std::string> settings{"statics.method=" + method};
    World world = load_world(read_scene(test::in_project("scenes/water/two-hands.toml"), settings));
    // Three waters far from each other: the winds and the client pull at one, each hand holds
    // another.
    const Entity free = add_free(world, "free", {0, 0, 60});
    add_free(world, "one", {0, 60, 0});
    add_free(world, "other", {0, -60, 0});
    const std::vector<Entity> hands = find_hands(world);
    GrabEdit{"one:1"}.apply(world, 0);
    GrabEdit{"other:1"}.apply(world, 1);
    const Vec3 start = centre_of(world, "free");
    constexpr double k = 2, gust = 0.7, client = 1.1;
    RestraintEdit{{"free:1"}, {{start.x(), start.y(), start.z()}}, k, 0}.apply(world, 0);
    world.set_resource(test::pull_molecule(world, free, {0, 0, client}));
    std::array<Vec3, 2> ends{};
    for (std::size_t i = 0; i < 2; ++i) ends[i] = held_place(world, hands[i]);
    for (int i = 0; i < 600; ++i) {
        blow_gust(world, free, gust);
        step_both(world);
    }
    // The restraint holds against all three.
    const Vec3 moved = centre_of(world, "free") - start;
    CHECK((moved - Vec3(wind, gust, client) / k).norm() < 0.03);
    // The hands hold theirs against the wind alone.
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 felt = contact_of(world, hands[i]).sent.model.force_newton;
        CHECK(held_place(world, hands[i]) == ends[i]);
        CHECK(felt.norm() < 0.03 * wind * units::newton_per_kcal_per_mol_angstrom);
    }
    // Each owner has its own springs, and their energy.
    // The wind pulls at the scene's waters too, which stay where they are.
    std::size_t waters = 0;
    world.each<Molecule>([&](Entity, const Molecule&) { ++waters; });
    waters -= hands.size();
    CHECK(find_springs(world, find_owner<Wind>(world)).size() == waters);
    CHECK(find_springs(world, find_owner<Gust>(world)).size() == 1);
    CHECK(find_springs(world, find_owner<Clients>(world)).size() == 3);
    CHECK(find_springs(world, Entity{}).size() == 1);
    CHECK(find_spring_energy(world, Entity{}) == Approx(k * moved.squaredNorm() / 2));
    CHECK(find_spring_energy(world, find_owner<Wind>(world)) ==
          Approx(static_cast<double>(waters) * wind * wind / 0.01 / 2).epsilon(0.05));
    CHECK(find_spring_energy(world, find_owner<Gust>(world)) ==
          Approx(gust * gust / 0.02 / 2).epsilon(0.05));
    CHECK(find_client_energy(world) == Approx(client * 100 / 2).epsilon(0.05));
    // Without the client the others go on.
    world.set_resource(ClientPull{{}, {}, world.resource<AtomTable>().size()});
    for (int i = 0; i < 600; ++i) {
        blow_gust(world, free, gust);
        step_both(world);
    }
    CHECK_FALSE(is_pulled_by_clients(world));
    CHECK((centre_of(world, "free") - start - Vec3(wind, gust, 0) / k).norm() < 0.03);
}
