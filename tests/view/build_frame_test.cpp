#include "view/build_frame.h"

#include "render/renderer.h"
#include "scene/read_scene.h"
#include "simulation/probe.h"
#include "tests/support/gpu.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "view/orbit_camera.h"
#include "view/palette.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr std::uint32_t height = 270;

ViewSettings shown_as(Representation representation) {
    return {.representation = representation, .force_arrow = false, .hydrogen_bonds = false};
}

}  // namespace

TEST_CASE("two waters are six spheres and four sticks, and an arrow along the force", "[view]") {
    Simulation simulation = load_simulation(test::water_scene());
    const double distance = GENERATE(2.5, 3.1);
    move_grabbed(simulation, distance);

    const FrameScene frame = build_frame(simulation, {.hydrogen_bonds = false});

    CHECK(frame.spheres.size() == 6);
    REQUIRE(frame.cones.size() >= 4 + 2);
    const ConeShape& shaft = frame.cones[4];
    const ConeShape& head = frame.cones[5];
    CHECK(head.pick == arrow_pick);
    // Pushed out at 2.5 Å, drawn in at 3.1; the arrow is beyond the molecule either way.
    CHECK((head.b - shaft.a).x * (distance < 2.7 ? 1 : -1) > 0);
    CHECK(glm::length(glm::cross(head.b - shaft.a, {1, 0, 0})) < 1e-5);
    CHECK(std::min(head.b.x, shaft.a.x) > frame.spheres[0].centre.x);

    CHECK(build_frame(simulation, shown_as(Representation::SpaceFilling)).cones.empty());
    CHECK(build_frame(simulation, shown_as(Representation::Licorice)).cones.size() == 4);
    // In hand: the fixed water is its oxygen alone.
    const FrameScene in_hand = build_frame(simulation, shown_as(Representation::InHand));
    CHECK(in_hand.spheres.size() == 4);
    CHECK(in_hand.cones.size() == 2);
}

TEST_CASE("every atom that nothing hides is seen at its centre, and all fit the picture",
          "[view][gpu]") {
    const auto representation = GENERATE(Representation::BallAndStick, Representation::SpaceFilling,
                                         Representation::Licorice);
    const float shape = GENERATE(as<float>{}, 480.0F / 270, 0.5F);
    const auto wide = static_cast<std::uint32_t>(static_cast<float>(height) * shape);
    GpuDevice device(test::validated());
    Renderer renderer(device);
    Simulation simulation = load_simulation(test::water_scene());
    FrameScene frame = build_frame(simulation, shown_as(representation));
    OrbitCamera camera;
    frame_all(camera, frame, shape);
    frame.camera = frame_camera(camera, frame);

    const Picture picture = renderer.draw(frame, wide, height);

    int seen = 0;
    for (std::size_t i = 0; i < frame.spheres.size(); ++i) {
        const glm::vec3 there = project(frame.camera, frame.spheres[i].centre, wide, height);
        REQUIRE(there.x > 0);
        REQUIRE(there.x < static_cast<float>(wide));
        REQUIRE(there.y > 0);
        REQUIRE(there.y < static_cast<float>(height));
        const std::size_t at =
            static_cast<std::size_t>(there.y) * wide + static_cast<std::size_t>(there.x);
        // Whatever is seen there is the atom, or before its centre.
        const bool is_atom = picture.picks[at] == i;
        CHECK((is_atom || picture.depth[at] < there.z));
        if (is_atom) ++seen;
    }
    CHECK(seen >= 3);  // one hydrogen is behind its oxygen, and sticks as thick as atoms hide some
    // Nothing is cut off at the edges.
    for (std::uint32_t x = 0; x < wide; ++x) {
        REQUIRE(picture.picks[x] == Picture::nothing_seen);
        REQUIRE(picture.picks[std::size_t{wide} * (height - 1) + x] == Picture::nothing_seen);
    }
    test::check_silent(device);
}

TEST_CASE("chains have carbons of their own colours, the grabbed molecule's stand out", "[view]") {
    Simulation simulation = load_simulation(test::water_scene());
    for (std::string& element : simulation.atoms.element) element = "C";
    simulation.atoms.names.back().segment = "OTHER";

    const auto colours = [&](Colouring colouring) {
        std::vector<glm::vec3> found;
        for (const SphereShape& s : build_frame(simulation, {.colouring = colouring}).spheres) {
            found.push_back(s.colour);
        }
        return found;
    };
    const std::vector<glm::vec3> by_chain = colours(Colouring::Chain),
                                 by_element = colours(Colouring::Element);

    CHECK(by_chain[0] != by_chain[3]);
    CHECK(by_chain[3] == by_chain[4]);
    CHECK(by_chain[4] != by_chain[5]);
    CHECK(by_element[3] == by_element[5]);
    CHECK(by_element[0] != by_element[3]);
    CHECK(by_chain[0] == by_element[0]);
}

TEST_CASE("of a molecule of which a spring holds a residue, that residue stands out", "[view]") {
    // Two peptides of four residues each; carbons of the second one are in a colour of their own.
    const std::vector<std::string> on_spring{"molecules.held.motion=free", "grab.atom=\"3\"",
                                             "statics.relax_steps=0"};
    const Simulation simulation =
        load_simulation(read_scene(test::test_data("two_peptides"), on_spring));
    const std::string in_hand = simulation.atoms.names.front().segment;
    std::vector<glm::vec3> found, rest, others;
    for (const SphereShape& sphere : build_frame(simulation, {.force_arrow = false}).spheres) {
        const AtomName& name = simulation.atoms.names[sphere.pick];
        if (name.atom.front() != 'C') continue;
        if (name.segment != in_hand) {
            others.push_back(sphere.colour);
        } else {
            (name.number == "3" ? found : rest).push_back(sphere.colour);
        }
    }
    REQUIRE((!found.empty() && !rest.empty() && !others.empty()));
    const auto all_are = [](const std::vector<glm::vec3>& colours, const glm::vec3& colour) {
        return std::ranges::all_of(colours, [&](const glm::vec3& c) { return c == colour; });
    };
    CHECK(all_are(found, grabbed_carbon));
    CHECK(all_are(rest, chain_carbons[0]));
    CHECK(all_are(others, chain_carbons[1]));
}

TEST_CASE("the arrow is seen on the molecule's free side, and covers none of its atoms",
          "[view][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    Simulation simulation = load_simulation(test::water_scene());
    const double distance = GENERATE(2.5, 3.1);
    move_grabbed(simulation, distance);
    FrameScene frame = build_frame(simulation, {});
    OrbitCamera camera;
    orbit(camera, 0.3F, 0.4F);
    frame_all(camera, frame, 480.0F / 270);
    frame.camera = frame_camera(camera, frame);
    const glm::vec3 base = project(frame.camera, frame.spheres[0].centre, 480, height);

    const Picture picture = renderer.draw(frame, 480, height);

    // Drawn in or pushed out, the other molecule is on the left.
    double columns = 0, pixels = 0;
    for (std::size_t i = 0; i < picture.picks.size(); ++i) {
        if (picture.picks[i] != arrow_pick) continue;
        columns += static_cast<double>(i % 480);
        ++pixels;
    }
    REQUIRE(pixels > 20);
    CHECK(columns / pixels - base.x > 20);
    CHECK(
        picture.picks[static_cast<std::size_t>(base.y) * 480 + static_cast<std::size_t>(base.x)] ==
        0);
    test::check_silent(device);
}
