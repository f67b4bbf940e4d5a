#include "view/hydrogen_bonds.h"

#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <vector>

using namespace palpa;

namespace {

World waters() { return load_world(test::water_scene()); }

// The first atoms, O, H, H, of the water in hand and of the other one.
std::uint32_t first_moved(const World& world) { return test::range_called(world, "moved").first; }
std::uint32_t first_fixed(const World& world) { return test::range_called(world, "fixed").first; }

// Puts a hydrogen of the water in hand at that distance (Å) from the other one's oxygen, its own
// oxygen at that angle (°).
void put_bond(World& world, double length, double angle_deg) {
    const double angle = angle_deg * std::numbers::pi / 180;
    const Vec3 acceptor(0, 0, 0), hydrogen(length, 0, 0);
    const Vec3 donor = hydrogen + 0.96 * Vec3(-std::cos(angle), std::sin(angle), 0);
    const Vec3 far(0, 0, 50);
    std::vector<Vec3>& positions = world.write<AtomTable>().positions;
    std::ranges::copy(std::array{donor, hydrogen, Vec3(donor + far)},
                      positions.begin() + first_moved(world));
    std::ranges::copy(std::array{acceptor, Vec3(-far), Vec3(-2 * far)},
                      positions.begin() + first_fixed(world));
}

}  // namespace

TEST_CASE("the bond of two waters is found, with its length", "[view][hydrogen-bonds]") {
    // The third one is too far away for a bond, or not in line.
    World world = test::three_waters(GENERATE(0, 1, 2), {0, GENERATE(2.8, 30.0), 0});
    move_grabbed(world, 2.77);
    const std::uint32_t moved = first_moved(world);

    const std::vector<HydrogenBond> bonds = find_hydrogen_bonds(world);

    REQUIRE(bonds.size() == 1);
    const HydrogenBond& bond = bonds[0];
    CHECK((bond.hydrogen == moved + 1 || bond.hydrogen == moved + 2));
    CHECK(bond.acceptor == first_fixed(world));
    // The hydrogen lies on the line between the oxygens, 0.957 Å from its own.
    CHECK(bond.length == Approx(2.77 - 0.957).margin(0.01));
    move_grabbed(world, 6);
    CHECK(find_hydrogen_bonds(world).empty());
}

TEST_CASE("2.5 Å and 120° are the ends of a hydrogen bond", "[view][hydrogen-bonds]") {
    World world = waters();
    const auto count = [&](double length, double angle) {
        put_bond(world, length, angle);
        return find_hydrogen_bonds(world).size();
    };

    CHECK(count(2.49, 180) == 1);
    CHECK(count(2.51, 180) == 0);
    CHECK(count(2.0, 121) == 1);
    CHECK(count(2.0, 119) == 0);
}

TEST_CASE("what gives and what accepts", "[view][hydrogen-bonds]") {
    World world = waters();
    put_bond(world, 2, 170);
    const std::uint32_t moved = first_moved(world), fixed = first_fixed(world);
    const auto count_with = [&](const std::string& donor, const std::string& acceptor) {
        world.write<AtomTable>().element.write()[moved] = donor;
        world.write<AtomTable>().element.write()[fixed] = acceptor;
        return find_hydrogen_bonds(world).size();
    };

    for (const char* polar : {"N", "O", "S"}) {
        CHECK(count_with(polar, "O") == 1);
        CHECK(count_with("O", polar) == 1);
    }
    CHECK(count_with("C", "O") == 0);
    CHECK(count_with("O", "C") == 0);

    // A nitrogen with four bonds has nothing to accept with.
    world.write<AtomTable>().bonds.push_back({fixed, moved + 2});
    CHECK(count_with("O", "N") == 1);
    world.write<AtomTable>().bonds.push_back({fixed, moved});
    CHECK(count_with("O", "N") == 0);
    CHECK(count_with("O", "O") == 1);
}

// Against all pairs, one by one, in a molecule where there are many.
TEST_CASE("hydrogen bonds in HIV-1 protease, the inhibitor's or all, are those of a plain search",
          "[view][hydrogen-bonds]") {
    const ShownBonds which = GENERATE(ShownBonds::InHand, ShownBonds::All);
    const SceneDescription scene =
        read_scene(test::in_project("scenes/hiv"), std::vector<std::string>());
    const World world = load_world(test::with_held_at(GENERATE(0, 1, 2), scene));
    const AtomTable& atoms = world.resource<AtomTable>();
    const auto is_in_hand = [&](std::size_t i) { return atoms.names[i].segment == "TL3C"; };
    std::set<std::tuple<std::size_t, std::size_t>> expected;
    for (const auto& [a, b] : atoms.bonds) {
        for (std::size_t acceptor = 0; acceptor < atoms.size(); ++acceptor) {
            for (const auto& [donor, hydrogen] : {std::pair(a, b), std::pair(b, a)}) {
                const auto polar = [&](std::size_t i) {
                    return std::string("NOS").find(atoms.element[i]) != std::string::npos;
                };
                if (atoms.element[hydrogen] != "H" || !polar(donor) || !polar(acceptor)) continue;
                if (acceptor == donor) continue;
                if (which == ShownBonds::InHand && is_in_hand(hydrogen) == is_in_hand(acceptor))
                    continue;
                const Vec3 x = atoms.positions[donor] - atoms.positions[hydrogen];
                const Vec3 y = atoms.positions[acceptor] - atoms.positions[hydrogen];
                const double angle = std::acos(x.dot(y) / x.norm() / y.norm());
                if (y.norm() < 2.5 && angle > 2 * std::numbers::pi / 3) {
                    expected.insert({hydrogen, acceptor});
                }
            }
        }
    }

    const std::vector<HydrogenBond> bonds = find_hydrogen_bonds(world, which);

    std::set<std::tuple<std::size_t, std::size_t>> found;
    for (const HydrogenBond& bond : bonds) found.insert({bond.hydrogen, bond.acceptor});
    CHECK(found == expected);
    CHECK(bonds.size() >= (which == ShownBonds::All ? 100 : 6));
    CHECK(find_hydrogen_bonds(world, ShownBonds::None).empty());
    for (std::size_t i = 1; i < bonds.size(); ++i) CHECK(bonds[i - 1].length <= bonds[i].length);
}
