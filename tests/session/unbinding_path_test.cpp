#include "session/unbinding_path.h"

#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

using namespace palpa;

TEST_CASE("of a hand on a spring the path is that of its residue", "[session][unbinding]") {
    World world = load_world(read_scene(
        test::in_project("scenes/hiv/flexible.toml"),
        std::vector<std::string>{"grab.molecule=protease_b", "grab.atom=\"50\"",
                                 "molecules.inhibitor.motion=free", "statics.relax_steps=0"}));
    const AtomTable& atoms = world.resource<AtomTable>();
    REQUIRE(has_mobile(world));
    const auto is_held = [&](std::size_t i) {
        return atoms.names[i].segment == "B" && atoms.names[i].number == "50";
    };
    const auto move_held_atoms = [&](double by) {
        for (std::size_t i = 0; i < atoms.size(); ++i) {
            if (!is_held(i)) continue;
            world.write<AtomTable>().positions[i].x() += by;
            world.write<TorsionState>().positions[i].x() += by;
        }
    };
    const auto find_clearance = [&] {
        double clearance = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < atoms.size(); ++i) {
            for (std::size_t j = 0; j < atoms.size(); ++j) {
                if (!is_held(i) || atoms.names[j].segment == "B") continue;
                if (atoms.mass[i] < 2 || atoms.mass[j] < 2) continue;
                clearance = std::min(clearance, (atoms.positions[i] - atoms.positions[j]).norm());
            }
        }
        return clearance;
    };
    const double at_start = find_clearance();
    UnbindingLog log(world);
    CHECK(log.unbinding().closest == Approx(at_start).epsilon(1e-12));

    move_held_atoms(0.5);
    log.add(world, 1.0);

    const double clearance = find_clearance();
    CHECK(log.unbinding().farthest == Approx(0.5).epsilon(1e-12));
    CHECK(log.unbinding().last_rmsd == Approx(0.5).epsilon(1e-12));
    CHECK(log.unbinding().clearance == Approx(clearance).epsilon(1e-12));
    CHECK(log.unbinding().closest == Approx(std::min(at_start, clearance)).epsilon(1e-12));
    CHECK(clearance > 1);

    move_held_atoms(-0.7);
    log.add(world, 1.0);

    // Not as far as before, on the other side: only what is the smallest of all may change.
    CHECK(log.unbinding().farthest == Approx(0.5).epsilon(1e-12));
    CHECK(log.unbinding().clearance == Approx(clearance).epsilon(1e-12));
    CHECK(log.unbinding().closest ==
          Approx(std::min({at_start, clearance, find_clearance()})).epsilon(1e-12));
    CHECK(log.unbinding().last_rmsd == Approx(0.2).epsilon(1e-12));
    CHECK(log.unbinding().last_backbone == 0);

    // Far away too, a part of a molecule is not free.
    move_held_atoms(100);
    log.add(world, 2.0);
    CHECK(log.unbinding().clearance > free_angstrom);
    CHECK_FALSE(log.unbinding().free_s.has_value());
    move_held_atoms(-100);
    log.add(world, 3.0);

    // What is not held counts as others, of the same chain too.
    const auto is_backbone = [&](std::size_t i) {
        const std::string& name = atoms.names[i].atom;
        return name == "N" || name == "CA" || name == "C" || name == "O";
    };
    std::size_t others = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (atoms.names[i].segment == "TL3C" || is_held(i) || !is_backbone(i)) continue;
        ++others;
        if (atoms.names[i].segment == "B" && atoms.names[i].number == "48") {
            world.write<AtomTable>().positions[i].z() += 2;
        }
    }
    log.add(world, 1.0);
    CHECK(log.unbinding().last_backbone ==
          Approx(2 * std::sqrt(4 / static_cast<double>(others))).epsilon(1e-12));
}
