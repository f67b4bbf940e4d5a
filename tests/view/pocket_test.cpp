#include "view/pocket.h"

#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
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
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

SceneDescription protease_scene() {
    return read_scene(test::in_project("scenes/hiv"), std::vector<std::string>());
}

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

TEST_CASE("residues are of every molecule, and waters have no CA", "[view][pocket]") {
    World world = load_world(test::with_held_at(GENERATE(0, 1), test::water_scene()));
    move_grabbed(world, 3);
    const std::size_t fixed = test::range_called(world, "fixed").first;
    const std::vector<ResidueSpan> residues = find_residues(world);

    REQUIRE(residues.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(residues[i].first == 3 * i);
        CHECK((residues[i].end == 3 * i + 3 && residues[i].alpha == residues[i].end));
    }
    const std::vector<bool> pocket = find_pocket(world, residues);
    for (std::size_t i = 0; i < 6; ++i) CHECK(pocket[i] == (i >= fixed && i < fixed + 3));
}

TEST_CASE("a residue ends where its molecule does, wherever the one in hand stands",
          "[view][pocket]") {
    World world = test::three_waters(GENERATE(0, 1, 2), {0, 20, 0});
    AtomTable& atoms = world.write<AtomTable>();
    // All of one name, and with a CA: so what is far away does not stand.
    for (AtomName& name : atoms.names.write()) {
        name.segment = "A";
        if (name.atom == "H1") name.atom = "CA";
    }
    move_grabbed(world, 3);
    const AtomRange fixed = test::range_called(world, "fixed");

    const std::vector<ResidueSpan> residues = find_residues(world);
    const std::vector<bool> pocket = find_pocket(world, residues);

    REQUIRE(residues.size() == 3);
    for (const ResidueSpan& residue : residues) {
        CHECK(residue.end == residue.first + 3);
        CHECK(residue.alpha == residue.first + 1);
    }
    for (std::size_t i = 0; i < 9; ++i) CHECK(pocket[i] == has_atom(fixed, i));
}

TEST_CASE("a pocket is a cartoon, with sticks near to what is held", "[view][pocket]") {
    const World world = test::protease_world();
    const AtomTable& atoms = world.resource<AtomTable>();
    const FrameScene frame = build_frame(world, {.representation = Representation::Pocket});
    const std::vector<bool> pocket = find_pocket(world, find_residues(world));
    const AtomRange held = held_range(world, hand_at(world, 0));

    REQUIRE(frame.meshes.size() == 1);
    std::set<std::uint32_t> ribbon;  // the atoms CA that it is picked as
    for (const MeshVertex& vertex : frame.meshes[0].vertices) ribbon.insert(vertex.pick);
    CHECK(ribbon.size() == 198);
    for (const SphereShape& sphere : frame.spheres)
        if (sphere.pick < atoms.size()) CHECK((has_atom(held, sphere.pick) || pocket[sphere.pick]));
}

TEST_CASE("drawn as a pocket, hydrogens of others are seen only in hydrogen bonds",
          "[view][pocket]") {
    const World world = load_world(test::with_held_at(GENERATE(0, 1, 2), protease_scene()));
    const AtomRange held = held_range(world, hand_at(world, 0));
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
