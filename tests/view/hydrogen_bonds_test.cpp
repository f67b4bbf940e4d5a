#include "view/hydrogen_bonds.h"

#include "simulation/probe.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <string>
#include <tuple>

using namespace palpa;

namespace {

Simulation waters() { return load_simulation(test::water_scene()); }

// Atoms of the water in hand come first: O, H, H; then those of the other one. Puts a hydrogen of
// the first at that distance (Å) from the other one's oxygen, its own oxygen at that angle (°).
void put_bond(Simulation& simulation, double length, double angle_deg) {
    const double angle = angle_deg * std::numbers::pi / 180;
    const Vec3 acceptor(0, 0, 0), hydrogen(length, 0, 0);
    const Vec3 donor = hydrogen + 0.96 * Vec3(-std::cos(angle), std::sin(angle), 0);
    const Vec3 far(0, 0, 50);
    simulation.atoms.positions = {donor, hydrogen, donor + far, acceptor, -far, -2 * far};
}

}  // namespace

TEST_CASE("the bond of two waters is found, with its length", "[view][hydrogen-bonds]") {
    Simulation simulation = waters();
    move_grabbed(simulation, 2.77);

    const std::vector<HydrogenBond> bonds = find_hydrogen_bonds(simulation);

    REQUIRE(bonds.size() == 1);
    const HydrogenBond& bond = bonds[0];
    CHECK(bond.hydrogen < 3);
    CHECK(bond.acceptor == 3);
    // The hydrogen lies on the line between the oxygens, 0.957 Å from its own.
    CHECK(bond.length == Approx(2.77 - 0.957).margin(0.01));
    move_grabbed(simulation, 6);
    CHECK(find_hydrogen_bonds(simulation).empty());
}

TEST_CASE("2.5 Å and 120° are the ends of a hydrogen bond", "[view][hydrogen-bonds]") {
    Simulation simulation = waters();
    const auto count = [&](double length, double angle) {
        put_bond(simulation, length, angle);
        return find_hydrogen_bonds(simulation).size();
    };

    CHECK(count(2.49, 180) == 1);
    CHECK(count(2.51, 180) == 0);
    CHECK(count(2.0, 121) == 1);
    CHECK(count(2.0, 119) == 0);
}

TEST_CASE("what gives and what accepts", "[view][hydrogen-bonds]") {
    Simulation simulation = waters();
    put_bond(simulation, 2, 170);
    const auto count_with = [&](const std::string& donor, const std::string& acceptor) {
        simulation.atoms.element[0] = donor;
        simulation.atoms.element[3] = acceptor;
        return find_hydrogen_bonds(simulation).size();
    };

    for (const char* polar : {"N", "O", "S"}) {
        CHECK(count_with(polar, "O") == 1);
        CHECK(count_with("O", polar) == 1);
    }
    CHECK(count_with("C", "O") == 0);
    CHECK(count_with("O", "C") == 0);

    // A nitrogen with four bonds has nothing to accept with.
    simulation.atoms.bonds.push_back({3, 2});
    CHECK(count_with("O", "N") == 1);
    simulation.atoms.bonds.push_back({3, 0});
    CHECK(count_with("O", "N") == 0);
    CHECK(count_with("O", "O") == 1);
}

// Against all pairs, one by one, in a molecule where there are many.
TEST_CASE("the inhibitor's hydrogen bonds in HIV-1 protease are those of a plain search",
          "[view][hydrogen-bonds]") {
    const Simulation simulation =
        load_simulation(read_scene(test::in_project("scenes/hiv"), std::vector<std::string>()));
    const AtomTable& atoms = simulation.atoms;
    const std::size_t grabbed = grabbed_points(simulation).positions.size();
    std::set<std::tuple<std::size_t, std::size_t>> expected;
    for (const auto& [a, b] : atoms.bonds) {
        for (std::size_t acceptor = 0; acceptor < atoms.size(); ++acceptor) {
            for (const auto& [donor, hydrogen] : {std::pair(a, b), std::pair(b, a)}) {
                const auto polar = [&](std::size_t i) {
                    return std::string("NOS").find(atoms.element[i]) != std::string::npos;
                };
                if (atoms.element[hydrogen] != "H" || !polar(donor) || !polar(acceptor)) continue;
                if ((hydrogen < grabbed) == (acceptor < grabbed)) continue;
                const Vec3 x = atoms.positions[donor] - atoms.positions[hydrogen];
                const Vec3 y = atoms.positions[acceptor] - atoms.positions[hydrogen];
                const double angle = std::acos(x.dot(y) / x.norm() / y.norm());
                if (y.norm() < 2.5 && angle > 2 * std::numbers::pi / 3) {
                    expected.insert({hydrogen, acceptor});
                }
            }
        }
    }

    const std::vector<HydrogenBond> bonds = find_hydrogen_bonds(simulation);

    std::set<std::tuple<std::size_t, std::size_t>> found;
    for (const HydrogenBond& bond : bonds) found.insert({bond.hydrogen, bond.acceptor});
    CHECK(found == expected);
    CHECK(bonds.size() >= 6);
    for (std::size_t i = 1; i < bonds.size(); ++i) CHECK(bonds[i - 1].length <= bonds[i].length);
}
