// A system of 30 lines is one file and one line in the list of the step: this program has the
// engine's own step.cpp with that line.
#include "core/files.h"
#include "core/text.h"
#include "core/units.h"
#include "simulation/edit.h"
#include "simulation/held.h"
#include "simulation/load.h"
#include "simulation/mechanics.h"
#include "simulation/molecules.h"
#include "simulation/step.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <string_view>

using namespace palpa;

namespace {

constexpr double wind = 0.5;  // kcal/mol/Å

// A water that moves by itself, far from the scene's two.
World water_in_the_wind() {
    World world = load_world(test::water_scene({"mode=4", "statics.method=quasi-static"}));
    add_molecule(world, {"TIP3", "", "free", {0, 0, 60}});
    set_mobility(world, {"free", Motion::Free, {}});
    return world;
}

Vec3 centre_of(const World& world, const std::string& molecule) {
    return centre_of_mass(world.resource<AtomTable>(),
                          world.find<Molecule>(molecule_called(world, molecule))->atoms);
}

void step(World& world, int steps) {
    for (int i = 0; i < steps; ++i)
        REQUIRE(step_world(world, HandPose{}, local_contact_of(world).model).finite);
}

}  // namespace

TEST_CASE("what engine/README.md shows of the wind is what runs here", "[wind]") {
    const auto text_of = [](const char* path) { return read_text_file(test::in_project(path)); };
    const std::string code = text_of("tests/simulation/wind/wind.cpp") +
                             text_of("engine/simulation/step.cpp") +
                             text_of("tests/simulation/CMakeLists.txt");
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
    CHECK(lines > 8);
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
    add_restraint(world, {{"free:1"}, {{start.x(), start.y(), start.z()}}, k, 0});
    step(world, 400);
    const Vec3 moved = centre_of(world, "free") - start;
    // The two other waters, 60 Å away, pull with less than a hundredth of that.
    CHECK(moved.x() == Approx(wind / k).epsilon(0.02));
    CHECK(moved.tail<2>().norm() < 0.02 * wind / k);
}

TEST_CASE("in a hand there is no wind", "[wind]") {
    World world = water_in_the_wind();
    take(world, first_hand(world), {"free"});
    const Vec3 place = held_place(world, first_hand(world));
    step(world, 20);
    CHECK((held_place(world, first_hand(world)) - place).norm() < 1e-12);
    CHECK(local_contact_of(world).model.force_newton.norm() <
          0.02 * wind * units::newton_per_kcal_per_mol_angstrom);
    let_go(world, first_hand(world));
    set_mobility(world, {"free", Motion::Free, {}});
    step(world, 20);
    CHECK(centre_of(world, "free").x() > place.x() + 0.01);
}

TEST_CASE("edits and undo find the wind as it was", "[wind]") {
    World world = water_in_the_wind();
    EditHistory history;
    history.apply(world, {0, 0, AddEdit{"TIP3", "", "other", {0, 30, 60}}, {"wind", 1, 0}});
    step(world, 20);
    CHECK(centre_of(world, "other").x() > 0.01);
    history.apply(world, {0, 0, UndoEdit{}, {"wind", 1, 0}});
    const double before = centre_of(world, "free").x();
    step(world, 20);
    CHECK(centre_of(world, "free").x() > before + 0.01);
}
