// The strokes of scenes/hiv, felt from the first tick to the last.
#include "devices/emulated_omni.h"
#include "haptics/servo.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/lockstep.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/emulated_hand.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// Every servo tick of a scene, as `palpa run` plays it.
std::vector<ServoTick> ticks_of(const std::string& path, const std::vector<std::string>& settings) {
    const SceneDescription scene = read_scene(test::in_project("scenes/hiv/" + path), settings);
    World world = load_world(scene);
    EmulatedOmni device(test::build_played_omni(scene, world));
    std::vector<ServoTick> ticks;
    run_lockstep(
        {static_cast<std::uint64_t>(scene.seconds * servo_rate_hz),
         static_cast<std::uint64_t>(scene.period_ms)},
        build_servo_settings(scene, world, 0), device, contact_at(world, 0),
        [&](const HandPose& hand, const ContactModel& felt) {
            (void)step_world(world, hand, felt);
            return contact_at(world, 0);
        },
        [&](const ServoTick& tick) { ticks.push_back(tick); });
    return ticks;
}

}  // namespace

TEST_CASE("TL-3 pulled within its pocket resists, and slides back when it is let go",
          "[session][slow]") {
    const std::vector<ServoTick> ticks = ticks_of("scene.toml", {"seconds=7"});
    const Vec3 rest = ticks.front().contact.molecule.place_angstrom;
    const ServoTick &held = ticks[3200], &last = ticks.back();

    const Vec3 pulled = held.contact.molecule.place_angstrom - rest;
    CHECK(pulled.x() > 0.25);
    CHECK(held.contact.force_newton.dot(pulled) < 0);
    CHECK(held.contact.force_newton.norm() > 3e-9);
    CHECK(held.sent_newton.norm() > 1);
    CHECK(held.contact.potential_kcal_per_mol > ticks.front().contact.potential_kcal_per_mol + 5);
    // Friction keeps the handle from the last of the way: 0.26 N where 17 N/m are felt, the softest
    // axis of the pocket's 100 N/m over A_d/A_f, is 15 mm or 0.07 Å.
    CHECK((last.contact.molecule.place_angstrom - rest).norm() < 0.075);
    CHECK(last.sent_newton.norm() < 0.27);
    CHECK(last.reading.position_m == ticks[ticks.size() - 500].reading.position_m);
}

TEST_CASE("TL-3 brought from outside is attracted, meets the surface and leaves it",
          "[session][slow]") {
    const std::vector<ServoTick> ticks = ticks_of("surface.toml", {});
    double attraction = 0, repulsion = 0;
    for (const ServoTick& tick : ticks) {
        attraction = std::min(attraction, tick.contact.force_newton.x());
        repulsion = std::max(repulsion, tick.contact.force_newton.x());
    }

    CHECK(attraction < -0.06e-9);
    CHECK(repulsion > 0.5e-9);
    CHECK(repulsion < 1.1e-9);
    const Vec3 way = ticks.back().contact.molecule.place_angstrom -
                     ticks.front().contact.molecule.place_angstrom;
    CHECK(way.norm() < 0.2);
}

TEST_CASE("in space the stiffest the hand feels is an eigenvalue, whatever its direction",
          "[session][coupling]") {
    const SceneDescription scene =
        read_scene(test::in_project("scenes/hiv"), std::vector<std::string>{"mode=4"});
    const World world = load_world(scene);
    const ContactModel rest = contact_at(world, 0).model;

    const FeltStiffness stiffest = stiffest_place(scene, world);

    // With constant gains the felt spring is A_f/A_d of the molecule's, stiffer off its rest.
    CHECK(stiffest.newton_per_metre > rest.stiffness_N_per_m * 0.38 / 2.2);
    CHECK(stiffest.newton_per_metre < 2 * rest.stiffness_N_per_m * 0.38 / 2.2);
    CHECK(list_warnings(scene, world, {}).empty());
    const SceneDescription strong =
        read_scene(test::in_project("scenes/hiv"), std::vector<std::string>{"mode=4", "A_f=3.8e9"});
    CHECK(stiffest_place(strong, load_world(strong)).newton_per_metre ==
          Approx(10 * stiffest.newton_per_metre));
    CHECK(list_warnings(strong, load_world(strong), {}).size() == 1);
}
