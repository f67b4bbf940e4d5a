// The scenes that palpa prepare made of entries run, and what their hands hold can be felt.
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/load.h"
#include "simulation/resources.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

using namespace palpa;

TEST_CASE("each scene of an entry runs for a second and is felt", "[session][entries]") {
    const std::string name = GENERATE("indinavir", "dna", "ubiquitin", "adenylate-kinase",
                                      "src-kinase", "rhodopsin", "bilayer");
    CAPTURE(name);
    SceneDescription scene = read_scene(test::in_project("scenes/" + name), {});
    scene.seconds = 1;
    World world = load_world(scene, {});
    const std::vector<Vec3> start = world.resource<AtomTable>().positions;
    EmulatedOmni device(build_emulated_omni(scene, world));
    const Summary summary = run_headless(scene, world, device, {}, nullptr, {});
    const std::vector<Vec3>& end = world.resource<AtomTable>().positions;
    CHECK(std::ranges::all_of(end, [](const Vec3& place) { return place.allFinite(); }));
    // The hand has moved by then, and what it holds with it.
    CHECK(end != start);
    CHECK(summary.largest_felt_N > 0.01);  // the stroke has begun half a second before
    CHECK(summary.largest_felt_N < 3.3);
}
