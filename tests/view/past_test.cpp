#include "view/past.h"

#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "view/build_frame.h"
#include "view/palette.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <iterator>
#include <string>
#include <vector>

using namespace palpa;

namespace {

ViewSettings plain() { return {.force_arrow = false, .hydrogen_bonds = ShownBonds::None}; }

std::vector<ConeShape> cones_of(const FrameScene& frame, std::uint32_t pick) {
    std::vector<ConeShape> cones;
    std::ranges::copy_if(frame.cones, std::back_inserter(cones),
                         [&](const ConeShape& cone) { return cone.pick == pick; });
    return cones;
}

void wait(World& world, std::uint64_t steps) { world.write<Clock>().steps += steps; }

}  // namespace

TEST_CASE("the ghost stands where what is in the hand was at the start", "[view][past]") {
    World world = test::three_waters(GENERATE(0, 1, 2), {0, 4, 0});
    move_grabbed(world, 2.8);
    const AtomRange held = held_range(world, hand_at(world, 0));
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<Vec3> start = atoms.positions;
    ViewSettings settings = plain();
    settings.marks.ghost = true;
    FrameBuilder builder;
    builder.follow(world, settings.marks);

    CHECK(cones_of(builder.build(world, {}, settings), ghost_pick).empty());  // not moved
    wait(world, 10);
    move_grabbed(world, 5);
    const FrameScene frame = builder.build(world, {}, settings);

    const std::vector<ConeShape> ghost = cones_of(frame, ghost_pick);
    REQUIRE(ghost.size() == 2);
    for (const ConeShape& bond : ghost) {
        for (const glm::vec3& end : {bond.a, bond.b}) {
            const auto is_there = [&](std::uint32_t i) { return as_float(start[i]) == end; };
            CHECK((is_there(held.first) || is_there(held.first + 1) || is_there(held.first + 2)));
        }
        CHECK(bond.radius_a < 0.11F);
        CHECK_FALSE(bond.is_on_top);
        for (std::size_t channel = 0; channel < 3; ++channel)
            CHECK(bond.colour_a[static_cast<int>(channel)] > 0.5F);  // pale
    }
    ViewSettings without = settings;
    without.marks.ghost = false;
    CHECK(cones_of(builder.build(world, {}, without), ghost_pick).empty());

    // A reset is a new start.
    world.write<Clock>().steps = 0;
    move_grabbed(world, 4);
    CHECK(cones_of(builder.build(world, {}, settings), ghost_pick).empty());
}

TEST_CASE("a reset by an edit is a new start, though steps are counted on", "[view][past]") {
    World world = test::three_waters(0, {0, 4, 0});
    ViewSettings settings = plain();
    settings.marks.ghost = true;
    FrameBuilder builder;
    builder.follow(world, settings.marks);
    wait(world, 10);
    move_grabbed(world, 5);
    REQUIRE_FALSE(cones_of(builder.build(world, {}, settings), ghost_pick).empty());

    // As where the file's place is another by now: what stood before is no ghost of this start.
    World again = world;
    ++again.write<Clock>().resets;
    CHECK(cones_of(builder.build(again, {}, settings), ghost_pick).empty());

    const std::uint64_t resets = world.resource<Clock>().resets;
    World edited = test::three_waters(0, {0, 4, 0});
    ResetEdit{}.apply(edited, 0);
    CHECK(edited.resource<Clock>().resets == resets + 1);
}

TEST_CASE("the ghost and what is old of the trail have the colour of the background",
          "[view][past]") {
    World world = test::three_waters(0, {0, 4, 0});
    ViewSettings settings = plain();
    settings.marks.ghost = true;
    settings.background = {0, 0, 1};
    FrameBuilder builder;
    builder.follow(world, settings.marks);
    wait(world, 10);
    move_grabbed(world, 5);
    const FrameScene frame = builder.build(world, {}, settings);
    CHECK(frame.background == settings.background);
    const std::vector<ConeShape> ghost = cones_of(frame, ghost_pick);
    REQUIRE_FALSE(ghost.empty());
    for (const ConeShape& bond : ghost) CHECK(bond.colour_a.z > bond.colour_a.x + 0.3F);
}

TEST_CASE("the ghost has residues around that moved by 0.5 Å, and no hydrogens on carbon",
          "[view][past]") {
    World world = test::protease_world();
    AtomTable& atoms = world.write<AtomTable>();
    const std::vector<ResidueSpan> residues = find_residues(world);
    const std::vector<bool> pocket = find_pocket(world, residues);
    const auto residue = std::ranges::find_if(residues, [&](const ResidueSpan& one) {
        return pocket[one.first] && atoms.names[one.first].residue == "ILE" &&
               atoms.names[one.first].number == "50";
    });
    REQUIRE(residue != residues.end());
    ViewSettings settings = plain();
    settings.representation = Representation::Lines;
    settings.marks.ghost = true;
    FrameBuilder builder;
    builder.follow(world, settings.marks);
    const auto count = [&](double by) {
        const Vec3 before = atoms.positions[residue->end - 1];
        for (std::size_t i = residue->first; i < residue->end; ++i)
            if (atoms.names[i].atom == "CD") atoms.positions[i] += Vec3(0, by, 0);
        const std::size_t found = cones_of(builder.build(world, {}, settings), ghost_pick).size();
        for (std::size_t i = residue->first; i < residue->end; ++i)
            if (atoms.names[i].atom == "CD") atoms.positions[i] -= Vec3(0, by, 0);
        CHECK(atoms.positions[residue->end - 1] == before);
        return found;
    };

    CHECK(count(0.4) == 0);
    // Of isoleucine's 8 heavy atoms 7 bonds, and that of the hydrogen on nitrogen.
    CHECK(count(0.6) == 8);
}

TEST_CASE("the trail is the way of the centre, fades, and is no longer than its time",
          "[view][past]") {
    World world = load_world(test::water_scene());
    const double period_s = world.resource<Clock>().period_s;
    const auto steps = [&](double seconds) {
        return static_cast<std::uint64_t>(std::lround(seconds / period_s));
    };
    const auto centre = [&] {
        return as_float(
            centre_of_mass(world.resource<AtomTable>(), held_range(world, hand_at(world, 0))));
    };
    ViewSettings settings = plain();
    settings.marks.trail_s = 1;
    FrameBuilder builder;
    std::vector<glm::vec3> way;
    for (int i = 0; i <= 20; ++i) {  // 2 s, 0.1 Å each tenth of a second
        if (i > 0) wait(world, steps(0.1));
        move_grabbed(world, 6 - 0.1 * i);
        way.push_back(centre());
        builder.follow(world, settings.marks);
    }

    const FrameScene frame = builder.build(world, {}, settings);

    const std::vector<ConeShape> trail = cones_of(frame, trail_pick);
    REQUIRE((trail.size() == 9 || trail.size() == 10));  // of the last second
    CHECK(glm::distance(trail.back().b, way.back()) < 1e-5F);
    CHECK(glm::distance(trail.front().a, way[20 - trail.size()]) < 1e-5F);
    CHECK(trail.back().colour_a == grabbed_carbon);
    for (std::size_t i = 1; i < trail.size(); ++i) {
        CHECK(trail[i].a == trail[i - 1].b);
        CHECK(trail[i].radius_a > trail[i - 1].radius_a);
        // Towards the white of the background.
        CHECK(trail[i].colour_a.r < trail[i - 1].colour_a.r);
    }

    SECTION("what stands still has none after that time") {
        wait(world, steps(1.5));
        CHECK(cones_of(builder.build(world, {}, settings), trail_pick).empty());
    }
    SECTION("a reset clears it") {
        world.write<Clock>().steps = 0;
        move_grabbed(world, 6);
        CHECK(cones_of(builder.build(world, {}, settings), trail_pick).empty());
        wait(world, steps(0.1));
        move_grabbed(world, 5.8);
        CHECK(cones_of(builder.build(world, {}, settings), trail_pick).size() == 1);
    }
    SECTION("what is undone leaves a gap") {
        wait(world, steps(0.1));
        move_grabbed(world, 10);
        for (const ConeShape& part : cones_of(builder.build(world, {}, settings), trail_pick))
            CHECK(glm::distance(part.a, part.b) < 0.2F);
    }
    SECTION("none is wanted") {
        settings.marks.trail_s = 0;
        CHECK(cones_of(builder.build(world, {}, settings), trail_pick).empty());
    }
}

TEST_CASE("a trail of many looks has few points, and ends where the molecule is", "[view][past]") {
    World world = load_world(test::water_scene());
    ViewMarks marks;
    marks.trail_s = 1000;
    Past past;
    for (int i = 0; i < 1000; ++i) {  // 1 Å in all
        wait(world, 1);
        move_grabbed(world, 5 - 1e-3 * i);
        past.follow(world, marks);
    }
    FrameScene frame;
    past.add_trail(marks.trail_s, frame);
    CHECK(frame.cones.size() > 10);
    CHECK(frame.cones.size() < 40);
    CHECK(glm::distance(frame.cones.back().b,
                        as_float(centre_of_mass(world.resource<AtomTable>(),
                                                held_range(world, hand_at(world, 0))))) < 1e-5F);
}

TEST_CASE("a ring stands where what is in the hand is at rest", "[view][past]") {
    const bool in_space = GENERATE(false, true);
    World world = load_world(
        in_space
            ? read_scene(test::in_project("scenes/water/space.toml"),
                         std::vector<std::string>{"hand.start_offset_angstrom=[2, 0.5, -0.25]"})
            : test::water_scene({"hand.start_angstrom=6"}));
    const Vec3 start = grabbed_place(world);
    ViewSettings settings = plain();
    settings.marks.ghost = true;
    std::vector<ViewLabel> labels;

    const FrameScene frame = FrameBuilder().build(world, {}, settings, &labels);

    REQUIRE(labels.size() == 1);
    CHECK(labels[0].text == "at rest");
    const glm::vec3 rest = labels[0].place;
    const std::vector<ConeShape> rings = cones_of(frame, rest_pick);
    CHECK(rings.size() > 20);
    for (const ConeShape& piece : rings) CHECK(glm::distance(piece.a, rest) == Approx(0.6));
    if (in_space) {
        CHECK(glm::distance(rest, as_float(start - Vec3(2, 0.5, -0.25))) < 1e-4F);
    } else {
        CHECK(glm::distance(rest, as_float(start)) > 2);
    }
    // Nothing pulls there, and something does half an ångström away.
    const auto force_at = [&](const Vec3& place) {
        place_grabbed(world, place - grip_of(world, hand_at(world, 0)).anchor);
        return field_on_grabbed(world).force.x();
    };
    const Vec3 there(rest.x, rest.y, rest.z);
    CHECK(std::abs(force_at(there)) < 1e-2);
    CHECK(force_at(there - Vec3(0.5, 0, 0)) > 1);
    CHECK(force_at(there + Vec3(0.5, 0, 0)) < -0.5);
}
