#include "forces/bonded.h"

#include "forces/fast_bonded.h"
#include "tests/support/check_forces.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

using namespace palpa;

namespace {

using std::numbers::pi;

const std::array bonds{Bond{0, 1, 300, 1.5}, Bond{2, 1, 250, 1.1}};
const std::array urey_bradleys{UreyBradley{0, 2, 22.5, 2.2}};
const std::array angles{Angle{0, 1, 2, 50, 1.9}, Angle{3, 1, 2, 35, 2.1}};
const std::array straight_angle{Angle{0, 1, 2, 50, pi}};
const std::array dihedrals{Dihedral{0, 1, 2, 3, 1, 0.8, 0}, Dihedral{0, 1, 2, 3, 2, 2.5, pi},
                           Dihedral{0, 1, 2, 3, 6, 0.3, 0.4}};
const std::array impropers{Improper{1, 0, 2, 3, 120, 0}, Improper{3, 2, 1, 0, 45, 0.6}};

// Many terms at a time, of one kind.
template <class Terms>
double add_fast(std::vector<Terms> Topology::* kind, std::span<const Terms> terms,
                std::span<const Vec3> positions, std::span<Vec3> forces) {
    Topology topology;
    (topology.*kind).assign(terms.begin(), terms.end());
    const BondedEnergy energy =
        add_fast_bonded_forces(build_fast_bonded(topology), positions, forces);
    return energy.bond + energy.angle + energy.urey_bradley + energy.dihedral + energy.improper;
}

// Every kind of term by name, so that all can be put to the same test.
struct Kind {
    const char* name;
    double (*add)(std::span<const Vec3>, std::span<Vec3>);
};
const std::array kinds = std::to_array<Kind>({
    {"bond", [](auto x, auto f) { return add_bond_forces(bonds, x, f); }},
    {"Urey-Bradley", [](auto x, auto f) { return add_urey_bradley_forces(urey_bradleys, x, f); }},
    {"angle", [](auto x, auto f) { return add_angle_forces(angles, x, f); }},
    {"straight angle", [](auto x, auto f) { return add_angle_forces(straight_angle, x, f); }},
    {"dihedral", [](auto x, auto f) { return add_dihedral_forces(dihedrals, x, f); }},
    {"improper", [](auto x, auto f) { return add_improper_forces(impropers, x, f); }},
    {"fast bond", [](auto x, auto f) { return add_fast<Bond>(&Topology::bonds, bonds, x, f); }},
    {"fast angle", [](auto x, auto f) { return add_fast<Angle>(&Topology::angles, angles, x, f); }},
    {"fast straight angle",
     [](auto x, auto f) { return add_fast<Angle>(&Topology::angles, straight_angle, x, f); }},
    {"fast dihedral",
     [](auto x, auto f) { return add_fast<Dihedral>(&Topology::dihedrals, dihedrals, x, f); }},
    {"fast improper",
     [](auto x, auto f) { return add_fast<Improper>(&Topology::impropers, impropers, x, f); }},
});

}  // namespace

TEST_CASE("a stretched bond pulls its atoms together", "[forces][bond]") {
    const std::vector<Vec3> positions{{0, 0, 0}, {1.7, 0, 0}};
    std::vector<Vec3> forces(2, Vec3::Zero());

    const double energy = add_bond_forces(std::array{Bond{0, 1, 300, 1.5}}, positions, forces);

    CHECK(energy == Approx(300 * 0.2 * 0.2).epsilon(1e-13));
    CHECK(forces[0].x() == Approx(2 * 300 * 0.2).epsilon(1e-13));
    CHECK(forces[1].x() == Approx(-2 * 300 * 0.2).epsilon(1e-13));
}

TEST_CASE("a Urey-Bradley spring pulls the ends of an angle", "[forces][urey_bradley]") {
    const std::vector<Vec3> positions{{0, 0, 0}, {9, 9, 9}, {0, 2.5, 0}};
    std::vector<Vec3> forces(3, Vec3::Zero());

    const double energy =
        add_urey_bradley_forces(std::array{UreyBradley{0, 2, 20, 2.2}}, positions, forces);

    CHECK(energy == Approx(20 * 0.3 * 0.3).epsilon(1e-13));
    CHECK(forces[0].y() == Approx(2 * 20 * 0.3).epsilon(1e-13));
    CHECK(forces[1] == Vec3(Vec3::Zero()));
}

TEST_CASE("an angle too wide is closed by its ends", "[forces][angle]") {
    const std::vector<Vec3> positions{{2, 0, 0}, {0, 0, 0}, {0, 1, 0}};
    std::vector<Vec3> forces(3, Vec3::Zero());

    const double energy =
        add_angle_forces(std::array{Angle{0, 1, 2, 50, pi / 2 - 0.1}}, positions, forces);

    CHECK(energy == Approx(50 * 0.01).epsilon(1e-12));
    // Torque 2 k 0.1 at arms of 2 and 1 Å.
    CHECK(forces[0].y() == Approx(10.0 / 2).epsilon(1e-12));
    CHECK(forces[2].x() == Approx(10.0 / 1).epsilon(1e-12));
}

TEST_CASE("a dihedral of multiplicity 3 is low where staggered, high where eclipsed",
          "[forces][dihedral]") {
    const auto at = [](double angle) {
        const std::vector<Vec3> positions{
            {0, 1, 0}, {0, 0, 0}, {0, 0, -1.5}, {std::sin(angle), std::cos(angle), -1.5}};
        std::vector<Vec3> forces(4, Vec3::Zero());
        const double energy =
            add_dihedral_forces(std::array{Dihedral{0, 1, 2, 3, 3, 0.2, 0}}, positions, forces);
        return std::pair{energy, forces};
    };

    CHECK(at(0).first == Approx(0.4).epsilon(1e-13));
    CHECK(at(pi / 3).first == Approx(0).margin(1e-13));
    CHECK(at(pi / 6).first == Approx(0.2).epsilon(1e-13));
    // From 30 degrees d is driven on clockwise, with 3 k at an arm of 1 Å.
    CHECK(at(pi / 6).second[3].norm() == Approx(0.6).epsilon(1e-13));
    CHECK(at(pi / 6).second[3].x() > 0);
}

TEST_CASE("an improper counts the short way round", "[forces][improper]") {
    const auto at = [](double angle, double psi0) {
        const std::vector<Vec3> positions{
            {0, 1, 0}, {0, 0, 0}, {0, 0, -1.5}, {std::sin(angle), std::cos(angle), -1.5}};
        std::vector<Vec3> forces(4, Vec3::Zero());
        return add_improper_forces(std::array{Improper{0, 1, 2, 3, 40, psi0}}, positions, forces);
    };

    CHECK(at(0.2, 0) == Approx(40 * 0.04).epsilon(1e-12));
    CHECK(at(-3.0, 3.0) == Approx(40 * std::pow(2 * pi - 6, 2)).epsilon(1e-12));
}

TEST_CASE("bonded forces are the derivative of the energy and move with the molecule",
          "[forces][bonded]") {
    std::mt19937 random(5);
    for (const Kind& kind : kinds) {
        for (int round = 0; round < 10; ++round) {
            INFO(kind.name << ", round " << round);
            test::check_forces(kind.add, test::random_positions(random, 4, 1.5, 0.8));
        }
    }
}

TEST_CASE("bonded forces are finite and balanced wherever the atoms are", "[forces][bonded]") {
    const double off = GENERATE(0.0, 1e-300, 1e-160, 1e-16, 1e-12, 1e-9, 1e-6, 1e-3);
    const std::vector<std::vector<Vec3>> geometries{
        {{0, 0, 0}, {0, 0, 0}, {off, 0, 0}, {0, off, off}},      // all at one place
        {{1, 0, 0}, {0, 0, 0}, {-1, off, 0}, {0, 1, 1}},         // angle of pi
        {{1, 0, 0}, {0, 0, 0}, {1.5, off, 0}, {0, 1, 1}},        // angle of 0
        {{0, 0, 1}, {0, 0, 0}, {off, 0, -1}, {0, -off, -2}},     // four in line
        {{1, 1, 0}, {1, 1, off}, {0, 0, -1}, {1, 0, -2}},        // a on b
        {{1, 1, 0}, {0, 0, 0}, {off, off, 0}, {1, 0, -2}},       // b on c
        {{1, 1, 0}, {0, 0, 0}, {0, 0, -1}, {1, 1 + off, 0}},     // d on a
        {{0, 1, 0}, {0, 0, 0}, {0, 0, -1.5}, {-off, -1, -1.5}},  // trans
    };

    for (const Kind& kind : kinds) {
        for (std::size_t i = 0; i < geometries.size(); ++i) {
            INFO(kind.name << ", geometry " << i << ", " << off << " Å off");
            test::check_balance(kind.add, geometries[i]);
        }
    }
}
