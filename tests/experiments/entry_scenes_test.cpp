// The scenes that palpa prepare made of entries run, and what their hands hold can be felt.
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/resources.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;

namespace {

Vec3 place_of(const AtomTable& atoms, const std::string& segment, int number,
              const std::string& name) {
    const auto found = std::ranges::find_if(atoms.names, [&](const AtomName& atom) {
        return atom.segment == segment && atom.number == std::to_string(number) &&
               atom.atom == name;
    });
    REQUIRE(found != atoms.names.end());
    return atoms.positions[static_cast<std::size_t>(found - atoms.names.begin())];
}

}  // namespace

TEST_CASE("the DNA at rest is a double helix of paired bases", "[session][entries][dna]") {
    const World world = load_world(read_scene(test::in_project("scenes/dna"), {}), {});
    const AtomTable& atoms = world.resource<AtomTable>();
    constexpr int pairs = 19;
    std::vector<Vec3> middles, across;  // from C1' to C1' of each pair
    for (int i = 1; i <= pairs; ++i) {
        const Vec3 one = place_of(atoms, "D", i, "C1'");
        const Vec3 other = place_of(atoms, "E", 2 * pairs + 1 - i, "C1'");
        middles.push_back(0.5 * (one + other));
        across.push_back(other - one);
    }
    const Vec3 axis = (middles.back() - middles.front()).normalized();
    double twist_deg = 0;
    for (std::size_t i = 1; i < across.size(); ++i) {
        const Vec3 a = (across[i - 1] - across[i - 1].dot(axis) * axis).normalized();
        const Vec3 b = (across[i] - across[i].dot(axis) * axis).normalized();
        twist_deg += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / std::numbers::pi;
    }
    // scenes/dna/README.md; of the crystal 60 Å and 623°, of ideal B-DNA 61 Å and 617°.
    CHECK((middles.back() - middles.front()).norm() == Approx(55).margin(0.5));
    CHECK(twist_deg == Approx(665).margin(2));
    for (const Vec3& way : across) CHECK(way.norm() < 12.5);  // 10.5 Å in B-DNA
}

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
