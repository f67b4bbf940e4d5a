#include "view/pocket.h"

#include "scene/read_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "view/build_frame.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

Simulation protease() {
    return load_simulation(read_scene(test::in_project("scenes/hiv"), std::vector<std::string>()));
}

}  // namespace

TEST_CASE("a pocket is the residues with an atom within 4.5 Å of the molecule in hand",
          "[view][pocket]") {
    const Simulation simulation = protease();
    const AtomTable& atoms = simulation.atoms;
    const std::size_t grabbed = grabbed_points(simulation).positions.size();
    std::map<std::pair<std::string, std::string>, double> nearest;  // of a residue, by its name
    const auto name_of = [&](std::size_t i) {
        return std::pair(atoms.names[i].segment, atoms.names[i].number);
    };
    for (std::size_t i = grabbed; i < atoms.size(); ++i) {
        double& least =
            nearest.try_emplace(name_of(i), std::numeric_limits<double>::infinity()).first->second;
        for (std::size_t k = 0; k < grabbed; ++k) {
            least = std::min(least, (atoms.positions[i] - atoms.positions[k]).norm());
        }
    }

    const std::vector<bool> pocket = find_pocket(simulation, find_residues(simulation));

    REQUIRE(pocket.size() == atoms.size());
    std::size_t shown = 0;
    for (std::size_t i = grabbed; i < atoms.size(); ++i) {
        REQUIRE(pocket[i] == (nearest[name_of(i)] < 4.5));
        shown += pocket[i] ? 1 : 0;
    }
    CHECK((shown > 200 && shown < atoms.size() / 2));
}

TEST_CASE("what has no backbone stands for itself", "[view][pocket]") {
    const Simulation simulation = load_simulation(test::water_scene());
    const std::vector<Residue> residues = find_residues(simulation);

    REQUIRE(residues.size() == 1);
    CHECK((residues[0].first == 3 && residues[0].end == 6 && residues[0].alpha == 6));
    const std::vector<bool> pocket = find_pocket(simulation, residues);
    CHECK(std::vector<bool>(pocket.begin() + 3, pocket.end()) == std::vector<bool>(3, true));
    FrameScene frame;
    add_backbones(simulation.atoms, residues, std::vector<glm::vec3>(6), frame);
    CHECK((frame.spheres.empty() && frame.cones.empty()));
}

TEST_CASE("a backbone is one smooth tube a chain, near to its atoms CA", "[view][pocket]") {
    const Simulation simulation = protease();
    const AtomTable& atoms = simulation.atoms;
    const std::vector<Residue> residues = find_residues(simulation);
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
    for (const Residue& residue : residues) {
        const glm::vec3 alpha = as_float(atoms.positions[residue.alpha]);
        const auto distance = [&](const ConeShape& cone) { return glm::distance(cone.a, alpha); };
        CHECK(std::ranges::min(frame.cones | std::views::transform(distance)) < 1.2F);
    }
    CHECK(frame.cones.front().a == as_float(atoms.positions[residues.front().alpha]));
}

TEST_CASE("a tube is open where residues are missing", "[view][pocket]") {
    const Simulation simulation = protease();
    std::vector<Residue> residues = find_residues(simulation);
    residues.erase(residues.begin() + 40, residues.begin() + 43);
    FrameScene frame;

    add_backbones(simulation.atoms, residues, std::vector<glm::vec3>(simulation.atoms.size()),
                  frame);

    std::size_t breaks = 0;
    for (std::size_t i = 1; i < frame.cones.size(); ++i) {
        breaks += frame.cones[i - 1].b != frame.cones[i].a ? 1 : 0;
    }
    CHECK(breaks == 2);
}

TEST_CASE("drawn as a pocket, hydrogens of others are seen only in hydrogen bonds",
          "[view][pocket]") {
    const Simulation simulation = protease();
    const auto grabbed = static_cast<std::uint32_t>(grabbed_points(simulation).positions.size());
    const FrameScene frame = build_frame(simulation, {.representation = Representation::Pocket});

    std::vector<std::uint32_t> hydrogens, bonded;
    for (const SphereShape& sphere : frame.spheres) {
        if (sphere.pick < grabbed || sphere.pick >= simulation.atoms.size()) continue;
        if (simulation.atoms.element[sphere.pick] == "H") hydrogens.push_back(sphere.pick);
    }
    for (const HydrogenBond& bond : find_hydrogen_bonds(simulation)) {
        if (bond.hydrogen >= grabbed) bonded.push_back(bond.hydrogen);
    }
    std::ranges::sort(bonded);
    bonded.erase(std::ranges::unique(bonded).begin(), bonded.end());
    CHECK(hydrogens == bonded);
    CHECK_FALSE(bonded.empty());
}
