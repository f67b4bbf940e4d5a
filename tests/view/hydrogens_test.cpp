// Which hydrogens are drawn.
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/resources.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "view/build_frame.h"
#include "view/hydrogen_bonds.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

using namespace palpa;

namespace {

FrameScene frame_of(const World& world, Representation representation, ShownHydrogens hydrogens,
                    ShownBonds bonds = ShownBonds::None) {
    return build_frame(world, {.representation = representation,
                               .force_arrow = false,
                               .hydrogen_bonds = bonds,
                               .hydrogens = hydrogens});
}

// Spheres of a residue of the protease's chain A.
std::size_t count(const World& world, const FrameScene& frame, const std::string& number) {
    const std::vector<AtomName>& names = world.resource<AtomTable>().names;
    std::size_t found = 0;
    for (const SphereShape& sphere : frame.spheres)
        found += names[sphere.pick].segment == "A" && names[sphere.pick].number == number ? 1 : 0;
    return found;
}

}  // namespace

TEST_CASE("polar hydrogens are those at nitrogen, oxygen and sulphur", "[view][hydrogens]") {
    const World world = test::protease_world();
    const Representation look = GENERATE(Representation::BallAndStick, Representation::SpaceFilling,
                                         Representation::Licorice, Representation::Lines);
    const FrameScene all = frame_of(world, look, ShownHydrogens::All),
                     polar = frame_of(world, look, ShownHydrogens::Polar),
                     none = frame_of(world, look, ShownHydrogens::None);

    // Lysine: N CA CB CG CD CE NZ C O, and HN HZ1 HZ2 HZ3, and HA and eight of its chain.
    CHECK(count(world, all, "7") == 9 + 4 + 9);
    CHECK(count(world, polar, "7") == 9 + 4);
    CHECK(count(world, none, "7") == 9);
    // Cysteine: N CA CB SG C O, and HN HG1, and HA HB1 HB2.
    CHECK(count(world, all, "67") == 6 + 2 + 3);
    CHECK(count(world, polar, "67") == 6 + 2);
    CHECK(count(world, none, "67") == 6);
    // A stick for every hydrogen that is there, none for one that is not.
    if (look != Representation::SpaceFilling) {
        CHECK(all.cones.size() - none.cones.size() == all.spheres.size() - none.spheres.size());
        CHECK(all.cones.size() - polar.cones.size() == all.spheres.size() - polar.spheres.size());
    }
}

TEST_CASE("hydrogens of hydrogen bonds that are drawn are always there", "[view][hydrogens]") {
    const World world = test::protease_world();
    const std::vector<HydrogenBond> bonds = find_hydrogen_bonds(world, ShownBonds::InHand);
    REQUIRE(bonds.size() > 3);
    const auto is_there = [&](const FrameScene& frame, std::uint32_t atom) {
        const glm::vec3 place = as_float(world.resource<AtomTable>().positions[atom]);
        return std::ranges::any_of(frame.spheres, [&](const SphereShape& sphere) {
            return sphere.pick == atom && sphere.centre == place;
        });
    };
    const FrameScene without = frame_of(world, Representation::Licorice, ShownHydrogens::None),
                     with = frame_of(world, Representation::Licorice, ShownHydrogens::None,
                                     ShownBonds::InHand);
    for (const HydrogenBond& bond : bonds) {
        CHECK_FALSE(is_there(without, bond.hydrogen));
        CHECK(is_there(with, bond.hydrogen));
    }
}

TEST_CASE("waters without hydrogens are their oxygens", "[view][hydrogens]") {
    const World world = load_world(test::water_scene());
    const auto count = [&](ShownHydrogens hydrogens) {
        return frame_of(world, Representation::BallAndStick, hydrogens).spheres.size();
    };
    CHECK(count(ShownHydrogens::All) == 6);
    CHECK(count(ShownHydrogens::Polar) == 6);
    CHECK(count(ShownHydrogens::None) == 2);
}

TEST_CASE("representations with rules of their own keep their hydrogens", "[view][hydrogens]") {
    const World world = test::protease_world();
    const Representation look = GENERATE(Representation::InHand, Representation::Pocket);
    CHECK(frame_of(world, look, ShownHydrogens::All).spheres.size() ==
          frame_of(world, look, ShownHydrogens::None).spheres.size());
}
