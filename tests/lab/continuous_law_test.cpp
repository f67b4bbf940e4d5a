// The law that closed paths are held against.
#include "tools/lab/experiments/continuous_law.h"
#include "core/units.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

using namespace palpa;

TEST_CASE("the continuous law is the static law along a line", "[experiments][coupling]") {
    const SceneDescription scene =
        read_scene(test::in_project("scenes/water"), std::vector<std::string>{});
    const World world = load_world(scene);
    const ServoSettings servo = build_servo_settings(scene, world, 0);
    ContinuousLaw law(*servo.guarded, load_world(scene));
    const double from = law.pose().place_angstrom.x();

    for (int i = 0; i < 1000; ++i) law.follow({Vec3(-0.09e-3, 0, 0)});
    const double inside = law.pose().place_angstrom.x(), way_in_J = law.work_joule();
    for (int i = 0; i < 1000; ++i) law.follow({Vec3(0.09e-3, 0, 0)});

    REQUIRE(inside < 3);
    CHECK(law.pose().place_angstrom.x() == Approx(from).margin(1e-4));
    CHECK(std::abs(law.work_joule()) < 1e-3 * std::abs(way_in_J));
    // The integral of f(F) A_d over the way.
    const CouplingLaws& laws = coupling_of(world, hand_at(world, 0)).laws;
    double work = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const LineForce line =
            force_along_line_at(world, from + (i + 0.5) / steps * (inside - from));
        work += hand_force(laws.force, line.force * units::newton_per_kcal_per_mol_angstrom) *
                gain_where(servo, laws, line) * (inside - from) / steps * units::metre_per_angstrom;
    }
    CHECK(way_in_J == Approx(work).epsilon(1e-3));
}

TEST_CASE("the continuous law turns what turns with the handle, and nothing else",
          "[experiments][coupling]") {
    const bool turns = GENERATE(true, false);
    const SceneDescription scene =
        read_scene(test::in_project("scenes/water/space.toml"),
                   std::vector<std::string>{turns ? "molecules.moved.motion=with-handle"
                                                  : "molecules.moved.motion=translate",
                                            "start_offset_angstrom=[6, 0, 0]"});
    const World world = load_world(scene);
    const ServoSettings servo = build_servo_settings(scene, world, 0);
    ContinuousLaw law(*servo.guarded, load_world(scene));
    const MoleculePose start = law.pose();
    const Quat turned = turn_of(Vec3(0.3, -0.2, 0.1));

    law.follow({Vec3(0, 0.01, 0), turned});

    CHECK(law.pose().orientation.angularDistance(turns ? Quat(turned * start.orientation)
                                                       : start.orientation) < 1e-9);
    CHECK((law.pose().place_angstrom - start.place_angstrom).norm() > 0.01);
}
