#include "view/pocket.h"

#include "scene/read_scene.h"
#include "simulation/held.h"
#include "simulation/load.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "view/build_frame.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

SceneDescription protease_scene() {
    return read_scene(test::in_project("scenes/hiv"), std::vector<std::string>());
}

World protease() { return load_world(protease_scene()); }

}  // namespace

TEST_CASE("a pocket is the residues with an atom within 4.5 Å of the molecule in hand",
          "[view][pocket]") {
    const std::size_t number = GENERATE(0, 1, 2);
    const World world = load_world(test::with_held_at(number, protease_scene()));
    const AtomTable& atoms = world.resource<AtomTable>();
    const auto is_in_hand = [&](std::size_t i) { return atoms.names[i].segment == "TL3C"; };
    std::map<std::pair<std::string, std::string>, double> nearest;  // of a residue, by its name
    const auto name_of = [&](std::size_t i) {
        return std::pair(atoms.names[i].segment, atoms.names[i].number);
    };
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (is_in_hand(i)) continue;
        double& least =
            nearest.try_emplace(name_of(i), std::numeric_limits<double>::infinity()).first->second;
        for (std::size_t k = 0; k < atoms.size(); ++k) {
            if (!is_in_hand(k)) continue;
            least = std::min(least, (atoms.positions[i] - atoms.positions[k]).norm());
        }
    }

    const std::vector<bool> pocket = find_pocket(world, find_residues(world));

    REQUIRE(pocket.size() == atoms.size());
    std::size_t shown = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        REQUIRE(pocket[i] == (!is_in_hand(i) && nearest[name_of(i)] < 4.5));
        shown += pocket[i] ? 1 : 0;
    }
    CHECK((shown > 200 && shown < atoms.size() / 2));
}

TEST_CASE("what has no backbone stands for itself", "[view][pocket]") {
    const World world = load_world(test::with_held_at(GENERATE(0, 1), test::water_scene()));
    const std::size_t fixed = test::range_called(world, "fixed").first;
    const std::vector<ResidueSpan> residues = find_residues(world);

    REQUIRE(residues.size() == 1);
    CHECK(residues[0].first == fixed);
    CHECK((residues[0].end == fixed + 3 && residues[0].alpha == fixed + 3));
    const std::vector<bool> pocket = find_pocket(world, residues);
    for (std::size_t i = 0; i < 6; ++i) CHECK(pocket[i] == (i >= fixed && i < fixed + 3));
    FrameScene frame;
    add_backbones(world.resource<AtomTable>(), residues, std::vector<glm::vec3>(6), frame);
    CHECK((frame.spheres.empty() && frame.cones.empty()));
}

TEST_CASE("a residue ends where its molecule does, wherever the one in hand stands",
          "[view][pocket]") {
    World world = test::three_waters(GENERATE(0, 1, 2), {0, 20, 0});
    AtomTable& atoms = world.resource<AtomTable>();
    // All of one name, and with a CA: so what is far away does not stand.
    for (AtomName& name : atoms.names) {
        name.segment = "A";
        if (name.atom == "H1") name.atom = "CA";
    }
    move_grabbed(world, 3);
    const AtomRange fixed = test::range_called(world, "fixed");

    const std::vector<ResidueSpan> residues = find_residues(world);
    const std::vector<bool> pocket = find_pocket(world, residues);

    REQUIRE(residues.size() == 2);
    for (const ResidueSpan& residue : residues) {
        CHECK(residue.end == residue.first + 3);
        CHECK(residue.alpha == residue.first + 1);
    }
    for (std::size_t i = 0; i < 9; ++i) CHECK(pocket[i] == has_atom(fixed, i));
}

TEST_CASE("a backbone is one smooth tube a chain, near to its atoms CA", "[view][pocket]") {
    const World world = protease();
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<ResidueSpan> residues = find_residues(world);
    FrameScene frame;
    add_backbones(atoms, residues, std::vector<glm::vec3>(atoms.size()), frame);

    std::size_t breaks = 0;
    for (std::size_t i = 1; i < frame.cones.size(); ++i) {
        const ConeShape& before = frame.cones[i - 1];
        const ConeShape& cone = frame.cones[i];
        CHECK(glm::distance(cone.a, cone.b) < 1);
        if (before.b != cone.a) {
            ++breaks;
            CHECK(atoms.names[before.pick].segment != atoms.names[cone.pick].segment);
            continue;
        }
        CHECK(glm::dot(glm::normalize(before.b - before.a), glm::normalize(cone.b - cone.a)) >
              0.7F);
    }
    CHECK(breaks == 1);  // two chains
    for (const ResidueSpan& residue : residues) {
        const glm::vec3 alpha = as_float(atoms.positions[residue.alpha]);
        const auto distance = [&](const ConeShape& cone) { return glm::distance(cone.a, alpha); };
        CHECK(std::ranges::min(frame.cones | std::views::transform(distance)) < 1.2F);
    }
    CHECK(frame.cones.front().a == as_float(atoms.positions[residues.front().alpha]));
}

TEST_CASE("a tube is open where residues are missing", "[view][pocket]") {
    const World world = protease();
    std::vector<ResidueSpan> residues = find_residues(world);
    residues.erase(residues.begin() + 40, residues.begin() + 43);
    FrameScene frame;

    add_backbones(world.resource<AtomTable>(), residues,
                  std::vector<glm::vec3>(world.resource<AtomTable>().size()), frame);

    std::size_t breaks = 0;
    for (std::size_t i = 1; i < frame.cones.size(); ++i) {
        breaks += frame.cones[i - 1].b != frame.cones[i].a ? 1 : 0;
    }
    CHECK(breaks == 2);
}

TEST_CASE("drawn as a pocket, hydrogens of others are seen only in hydrogen bonds",
          "[view][pocket]") {
    const World world = load_world(test::with_held_at(GENERATE(0, 1, 2), protease_scene()));
    const AtomRange held = held_range(world, first_hand(world));
    const FrameScene frame = build_frame(world, {.representation = Representation::Pocket});

    std::vector<std::uint32_t> hydrogens, bonded;
    for (const SphereShape& sphere : frame.spheres) {
        if (has_atom(held, sphere.pick)) continue;
        if (sphere.pick >= world.resource<AtomTable>().size()) continue;
        if (world.resource<AtomTable>().element[sphere.pick] == "H")
            hydrogens.push_back(sphere.pick);
    }
    for (const HydrogenBond& bond : find_hydrogen_bonds(world)) {
        if (!has_atom(held, bond.hydrogen)) bonded.push_back(bond.hydrogen);
    }
    std::ranges::sort(bonded);
    bonded.erase(std::ranges::unique(bonded).begin(), bonded.end());
    CHECK(hydrogens == bonded);
    CHECK_FALSE(bonded.empty());
}
