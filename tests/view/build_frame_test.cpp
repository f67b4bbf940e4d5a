#include "view/build_frame.h"

#include "loading/edit.h"
#include "loading/load.h"
#include "render/renderer.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "tests/support/gpu.h"
#include "tests/support/held_scene.h"
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
    return {
        .representation = representation, .force_arrow = false, .hydrogen_bonds = ShownBonds::None};
}

}  // namespace

TEST_CASE("two waters are six spheres and four sticks, and an arrow along the force", "[view]") {
    World world = load_world(test::water_scene());
    const double distance = GENERATE(2.5, 3.1);
    move_grabbed(world, distance);

    const FrameScene frame = build_frame(world, {.hydrogen_bonds = ShownBonds::None});

    CHECK(frame.spheres.size() == 6);
    REQUIRE(frame.cones.size() >= 4 + 2);
    const ConeShape& shaft = frame.cones[4];
    const ConeShape& head = frame.cones[5];
    CHECK(head.pick == arrow_pick);
    // Pushed out at 2.5 Å, drawn in at 3.1; the arrow is beyond the molecule either way.
    CHECK((head.b - shaft.a).x * (distance < 2.7 ? 1 : -1) > 0);
    CHECK(glm::length(glm::cross(head.b - shaft.a, {1, 0, 0})) < 1e-5);
    CHECK(std::min(head.b.x, shaft.a.x) > as_float(grabbed_place(world)).x);

    CHECK(build_frame(world, shown_as(Representation::SpaceFilling)).cones.empty());
    CHECK(build_frame(world, shown_as(Representation::Licorice)).cones.size() == 4);
    // In hand: the fixed water is its oxygen alone.
    const FrameScene in_hand = build_frame(world, shown_as(Representation::InHand));
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
    World world = load_world(test::water_scene());
    FrameScene frame = build_frame(world, shown_as(representation));
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
    World world = test::three_waters(GENERATE(0, 1, 2), {0, 4, 0});
    for (std::string& element : world.write<AtomTable>().element.write()) element = "C";
    const AtomRange third = test::range_called(world, "third");
    world.write<AtomTable>().names.write()[third.first + 2].segment = "OTHER";

    // Three of what is held, three of the fixed water, three of the third.
    const auto colours = [&](Colouring colouring) {
        const FrameScene frame = build_frame(world, {.colouring = colouring});
        std::vector<glm::vec3> found;
        for (const char* const name : {"moved", "fixed", "third"}) {
            for (const SphereShape& s : shapes_of(frame, test::range_called(world, name)))
                found.push_back(s.colour);
        }
        return found;
    };
    const std::vector<glm::vec3> by_chain = colours(Colouring::Chain),
                                 by_element = colours(Colouring::Element);

    REQUIRE((by_chain.size() == 9 && by_element.size() == 9));
    CHECK(by_chain[0] != by_chain[3]);
    CHECK(by_chain[3] == chain_carbons[0]);
    CHECK(by_chain[3] == by_chain[5]);
    CHECK(by_chain[5] == by_chain[7]);  // of one name
    CHECK(by_chain[8] == chain_carbons[1]);
    CHECK(by_element[3] == by_element[8]);
    CHECK(by_element[0] != by_element[3]);
    CHECK(by_chain[0] == by_element[0]);
}

TEST_CASE("of a molecule of which a spring holds a residue, that residue stands out", "[view]") {
    // Two peptides of four residues each; carbons of each are in a colour of their own.
    const std::string residue = GENERATE("1", "3");
    const std::size_t number = GENERATE(0, 1);
    const std::vector<std::string> on_spring{
        "molecules.held.motion=free", "grab.atom=\"" + residue + "\"", "statics.relax_steps=0"};
    const World world = load_world(
        test::with_held_at(number, read_scene(test::test_data("two_peptides"), on_spring)));
    const AtomRange in_hand = held_range(world, hand_at(world, 0));
    std::vector<glm::vec3> found, rest, others;
    for (const SphereShape& sphere : build_frame(world, {.force_arrow = false}).spheres) {
        const AtomName& name = world.resource<AtomTable>().names[sphere.pick];
        if (name.atom.front() != 'C') continue;
        if (!has_atom(in_hand, sphere.pick)) {
            others.push_back(sphere.colour);
        } else {
            (name.number == residue ? found : rest).push_back(sphere.colour);
        }
    }
    REQUIRE((!found.empty() && !rest.empty() && !others.empty()));
    const auto all_are = [](const std::vector<glm::vec3>& colours, const glm::vec3& colour) {
        return std::ranges::all_of(colours, [&](const glm::vec3& c) { return c == colour; });
    };
    CHECK(all_are(found, grabbed_carbon));
    CHECK(all_are(rest, chain_carbons[number]));
    CHECK(all_are(others, chain_carbons[1 - number]));
}

TEST_CASE("each molecule is drawn as its appearance says, and all others as the settings do",
          "[view]") {
    World world = load_world(test::water_scene());
    for (std::string& element : world.write<AtomTable>().element.write()) element = "C";
    move_grabbed(world, 2.8);
    ViewSettings settings = shown_as(Representation::BallAndStick);
    settings.hydrogen_bonds = ShownBonds::InHand;
    const AtomRange moved = held_range(world, hand_at(world, 0));
    const auto spheres_of_moved = [&] { return shapes_of(build_frame(world, settings), moved); };
    const auto find_fixed = [&](const FrameScene& frame) {
        return *std::ranges::find_if(frame.spheres, [&](const SphereShape& sphere) {
            return !has_atom(moved, sphere.pick);
        });
    };
    const std::vector<SphereShape> before = spheres_of_moved();
    const glm::vec3 fixed_colour = find_fixed(build_frame(world, settings)).colour;

    AppearanceEdit{"fixed", Representation::SpaceFilling, Colouring::Element, {}}.apply(world, 0);
    FrameScene frame = build_frame(world, settings);
    CHECK(frame.cones.size() == 2);  // of the other one
    CHECK(find_fixed(frame).radius > 3 * before.front().radius);
    CHECK(find_fixed(frame).colour != fixed_colour);
    CHECK(spheres_of_moved().front().radius == before.front().radius);
    CHECK(spheres_of_moved().front().colour == before.front().colour);
    // What it does not say stays that of the settings, and what it says stays.
    settings.representation = Representation::Licorice;
    CHECK(build_frame(world, settings).cones.size() == 2);
    CHECK(spheres_of_moved().front().radius != before.front().radius);

    AppearanceEdit{"fixed", {}, {}, false}.apply(world, 0);
    frame = build_frame(world, settings);
    CHECK(frame.spheres.size() == 3);
    AppearanceEdit{"fixed", {}, {}, true}.apply(world, 0);
    CHECK(build_frame(world, settings).spheres.size() == 6);
}

TEST_CASE("one molecule as a ribbon, the other in full", "[view]") {
    World world = load_world(read_scene(test::test_data("two_peptides")));
    const ViewSettings settings = shown_as(Representation::BallAndStick);
    const FrameScene full = build_frame(world, settings);
    AppearanceEdit{"resting", Representation::Pocket, {}, {}}.apply(world, 0);
    const FrameScene mixed = build_frame(world, settings);
    const AtomRange held = held_range(world, hand_at(world, 0));

    CHECK(shapes_of(mixed, held).size() == shapes_of(full, held).size());
    CHECK(full.meshes.empty());
    REQUIRE(mixed.meshes.size() == 1);
    for (const MeshVertex& vertex : mixed.meshes[0].vertices)
        CHECK_FALSE(has_atom(held, vertex.pick));
    AppearanceEdit{"resting", {}, {}, false}.apply(world, 0);
    CHECK(build_frame(world, settings).spheres.size() == shapes_of(full, held).size());
}

TEST_CASE("hydrogen bonds of what is hidden are not drawn", "[view]") {
    World world = load_world(test::water_scene());
    move_grabbed(world, 2.8);
    const ViewSettings settings{.force_arrow = false};
    const auto dashes = [&] {
        return std::ranges::count(build_frame(world, settings).cones, hydrogen_bond_pick,
                                  &ConeShape::pick);
    };
    CHECK(dashes() > 0);
    AppearanceEdit{"fixed", {}, {}, false}.apply(world, 0);
    CHECK(dashes() == 0);
}

TEST_CASE("a snap is marked at its atom for a second and a half", "[view][signs]") {
    World world = load_world(test::water_scene());
    const ViewSettings settings = shown_as(Representation::BallAndStick);
    std::vector<ViewLabel> labels;
    const auto marks_after = [&](double s) {
        Clock& clock = world.write<Clock>();
        clock.steps = 100 + static_cast<std::uint64_t>(s / clock.period_s);
        std::vector<glm::vec3> places;
        for (const ConeShape& cone : build_frame(world, {}, settings, &labels).cones) {
            if (cone.pick == snap_pick) places.push_back(0.5F * (cone.a + cone.b));
        }
        return places;
    };
    SecondOrder second;
    world.set_resource(Solver{second});
    CHECK(marks_after(0).empty());
    second.snap = {4, 12.3, 100};
    world.set_resource(Solver{second});

    const std::vector<glm::vec3> places = marks_after(1.4);

    REQUIRE(places.size() >= 10);
    const glm::vec3 atom = as_float(world.resource<AtomTable>().positions[4]);
    for (const glm::vec3& place : places) CHECK(glm::distance(place, atom) < 1.5F);
    CHECK(labels.back().text == "snap, 12 kcal/mol released");
    CHECK(marks_after(1.6).empty());
}

TEST_CASE("a hand that holds nothing has no arrow and no bonds, and all is drawn as it is",
          "[view]") {
    World world = load_world(test::water_scene());
    move_grabbed(world, 2.8);
    const Representation representation =
        GENERATE(Representation::BallAndStick, Representation::InHand, Representation::Pocket);
    ReleaseEdit{}.apply(world, 0);
    const FrameScene frame = build_frame(world, {.representation = representation});
    CHECK(std::ranges::all_of(frame.cones,
                              [](const ConeShape& cone) { return cone.pick < first_sign_pick; }));
    CHECK(frame.spheres.size() >= 2);
}

TEST_CASE("the arrow is seen on the molecule's free side, and covers none of its atoms",
          "[view][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    World world = load_world(test::water_scene());
    const double distance = GENERATE(2.5, 3.1);
    move_grabbed(world, distance);
    FrameScene frame = build_frame(world, {});
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
