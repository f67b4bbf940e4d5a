#include "view/force_parts.h"

#include "core/units.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "view/build_frame.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

std::vector<ForcePart> find_parts(const World& world, ShownForces of,
                                  double least_nN = least_shown_nN) {
    const Entity hand = hand_at(world, 0);
    return find_force_parts(world, hand, gather_held(world, held_atoms(world, hand)), of,
                            find_residues(world), least_nN);
}

Vec3 sum_of(const std::vector<ForcePart>& parts) {
    Vec3 sum = Vec3::Zero();
    for (const ForcePart& part : parts) sum += part.force;
    return sum;
}

// From tail to tip, of every arrow of parts.
std::vector<glm::vec3> list_arrows(const FrameScene& frame) {
    std::vector<glm::vec3> arrows;
    for (std::size_t i = 0; i + 1 < frame.cones.size(); ++i) {
        if (frame.cones[i].pick != force_part_pick) continue;
        const ConeShape &shaft = frame.cones[i], &head = frame.cones[i + 1];
        CHECK(head.pick == force_part_pick);
        CHECK(head.a == shaft.b);
        CHECK(head.radius_a > shaft.radius_a);
        arrows.push_back(head.b - shaft.a);
        ++i;
    }
    return arrows;
}

}  // namespace

TEST_CASE("the forces of all residues, or of all atoms, sum to the force on the hand",
          "[view][forces]") {
    World world = GENERATE(0, 1) == 0 ? test::protease_world() : test::three_waters(1, {2, 3, 1});
    const Entity hand = hand_at(world, 0);
    // Another place than that of rest, where forces cancel.
    place_grabbed(world, grip_of(world, hand).pose.place_angstrom + Vec3(0.4, 0, 0));
    const Vec3 whole = grip_of(world, hand).projector * field_on_held(world, hand).force;
    const ShownForces of = GENERATE(ShownForces::Residues, ShownForces::Atoms);

    const std::vector<ForcePart> parts = find_parts(world, of, 0);

    REQUIRE(whole.norm() > 0.1);
    CHECK((sum_of(parts) - whole).norm() < 1e-9 * whole.norm());
    // What the hand's arrow shows, in newtons.
    const Vec3 felt = find_contacts(world)[0].force_newton;
    CHECK((sum_of(parts) * units::newton_per_kcal_per_mol_angstrom - felt).norm() <
          1e-4 * felt.norm());
    CHECK(std::ranges::is_sorted(parts, std::greater(),
                                 [](const ForcePart& part) { return part.force.norm(); }));
    const AtomRange held = held_range(world, hand);
    for (const ForcePart& part : parts) {
        CHECK_FALSE(has_atom(held, part.first));
        CHECK((of == ShownForces::Residues || part.end == part.first + 1));
    }
    CHECK(find_parts(world, ShownForces::Hand, 0).empty());
}

TEST_CASE("with a reach, forces are those of the atoms in it alone", "[view][forces]") {
    const World world = test::three_waters(0, {0, 40, 0});
    const HeldPoints held = gather_held(world, held_atoms(world, hand_at(world, 0)));
    const AtomRange fixed = test::range_called(world, "fixed");
    const AtomRange third = test::range_called(world, "third");

    const std::vector<Vec3> all = find_forces_by_atoms(world, held);
    const std::vector<Vec3> near = find_forces_by_atoms(world, held, 12);

    for (std::uint32_t i = 0; i < all.size(); ++i) {
        CHECK(all[i].isZero(0) == has_atom(held_range(world, hand_at(world, 0)), i));
        const Vec3 expected = has_atom(third, i) ? Vec3(Vec3::Zero()) : all[i];
        CHECK((near[i] - expected).norm() <= 1e-12 * expected.norm());
    }
    CHECK(near[fixed.first].norm() > 0);
    CHECK(all[third.first].norm() > 0);
}

TEST_CASE("of two waters the other one does all: its arrow is as long as the hand's",
          "[view][forces]") {
    World world = load_world(test::water_scene());
    const double distance = GENERATE(2.5, 3.1);
    move_grabbed(world, distance);
    const double felt_nN = 1e9 * find_contacts(world)[0].force_newton.norm();
    ViewSettings settings{.hydrogen_bonds = ShownBonds::None};
    settings.marks.forces = ShownForces::Residues;
    std::vector<ViewLabel> labels;

    const FrameScene frame = build_frame(world, settings, &labels);

    const std::vector<glm::vec3> arrows = list_arrows(frame);
    REQUIRE(arrows.size() == 1);
    const auto shaft = std::ranges::find(frame.cones, arrow_pick, &ConeShape::pick);
    const glm::vec3 of_hand = (shaft + 1)->b - shaft->a;
    CHECK(glm::distance(arrows[0], of_hand) < 1e-3F);
    CHECK(glm::length(arrows[0]) ==
          Approx(0.8 * std::log10(felt_nN / least_shown_nN)).epsilon(1e-3));
    // Between the two, wherever it points: the fixed water is at smaller x than the moved one.
    const auto part = std::ranges::find(frame.cones, force_part_pick, &ConeShape::pick);
    const float x = as_float(grabbed_place(world)).x, tail = part->a.x, tip = (part + 1)->b.x;
    CHECK((distance < 2.7 ? tail < tip : tip < tail));
    CHECK(std::max(tail, tip) == Approx(x).margin(1));
    CHECK(std::min(tail, tip) < x - 1);
    const std::string text = fmt::format("FIX:TIP3 1 {}", force_in_words(felt_nN));
    CHECK(std::ranges::count(labels, text, &ViewLabel::text) == 1);
    settings.marks.forces = ShownForces::Hand;
    CHECK(list_arrows(build_frame(world, settings)).empty());
}

TEST_CASE("of many the strongest 10 residues or 20 atoms are drawn, with their names",
          "[view][forces]") {
    const World world = test::protease_world();
    const AtomTable& atoms = world.resource<AtomTable>();
    const auto [of, most] =
        GENERATE(std::pair(ShownForces::Residues, 10), std::pair(ShownForces::Atoms, 20));
    ViewSettings settings{.force_arrow = false, .hydrogen_bonds = ShownBonds::None};
    settings.marks.forces = of;
    std::vector<ViewLabel> labels;

    const FrameScene frame = build_frame(world, {}, settings, &labels);

    const std::vector<ForcePart> parts = find_parts(world, of);
    const std::vector<glm::vec3> arrows = list_arrows(frame);
    REQUIRE(arrows.size() == static_cast<std::size_t>(most));
    REQUIRE(labels.size() == arrows.size());
    REQUIRE(parts.size() > arrows.size());
    for (std::size_t i = 0; i < arrows.size(); ++i) {
        const AtomName& name = atoms.names[parts[i].first];
        CHECK_THAT(labels[i].text,
                   Catch::Contains(fmt::format("{} {}", name.residue, name.number)));
        CHECK((labels[i].text.find(" " + name.atom + " ") != std::string::npos) ==
              (of == ShownForces::Atoms));
        CHECK(labels[i].is_tick == (i >= 6));
        CHECK(glm::dot(glm::normalize(arrows[i]), as_float(parts[i].force.normalized())) > 0.9999F);
    }
}

TEST_CASE("an arrow of attraction starts on what is held, one of repulsion ends there",
          "[view][forces]") {
    const ForceEnds ends{{5, 0, 0}, {1, 0, 0}};
    FrameScene frame;

    CHECK(add_force_part({0.1, 0, 0}, ends, 1, frame) == glm::vec3(3, 0, 0));  // two decades
    CHECK(frame.cones.at(0).a == glm::vec3(1, 0, 0));
    CHECK(frame.cones.at(1).b == glm::vec3(3, 0, 0));

    CHECK(add_force_part({-0.1, 0, 0}, ends, 1, frame) == glm::vec3(3, 0, 0));
    CHECK(frame.cones.at(2).a == glm::vec3(3, 0, 0));
    CHECK(frame.cones.at(3).b == glm::vec3(1, 0, 0));
}
