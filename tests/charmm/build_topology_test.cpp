#include "charmm/build_topology.h"

#include "tests/support/force_field_of.h"
#include "tests/support/load_error_of.h"

#include <fmt/format.h>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;
using test::force_field_of;
using test::load_error_of;

namespace {

// Atom types A, B, C, D with numbers 1 to 4, bonds and angles, and `more` parameters.
ForceField force_field_with(const std::string& more) {
    ForceField force_field =
        force_field_of("MASS 1 A 12.0 C\nMASS 2 B 12.0 C\nMASS 3 C 12.0 C\nMASS 4 D 12.0 C\n");
    parse_force_field(
        "NONBONDED\nA 0.0 -0.1 2.0 0.0 -0.4 1.5\nB 0.0 -0.1 2.0\nC 0.0 -0.1 2.0\nD 0.0 -0.1 2.0\n"
        "BONDS\nB A 100.0 1.5\nB C 100.0 1.5\nD C 100.0 1.5\n" +
            more + "END\n",
        "a.prm", force_field);
    return force_field;
}

// Four atoms in a row, by their types.
Connectivity chain_of(const std::vector<std::string>& types) {
    Connectivity chain;
    chain.file = "s.psf";
    chain.type = types;
    for (std::uint32_t i = 0; i < types.size(); ++i) {
        chain.names.push_back({"P", "R", "1", fmt::format("X{}", i)});
        chain.charge.push_back(0.1 * i);
        chain.mass.push_back(12);
        chain.lines.push_back(i + 1);
        if (i > 0) chain.bonds.push_back({i - 1, i});
    }
    return chain;
}

// The force constants of the one dihedral or improper of a chain A-B-C-D.
std::vector<double> constants(const std::string& more, bool is_improper) {
    Connectivity chain = chain_of({"A", "B", "C", "D"});
    (is_improper ? chain.impropers : chain.dihedrals).push_back({0, 1, 2, 3});
    const Topology topology = build_topology(
        chain,
        force_field_with(fmt::format("{}\n{}", is_improper ? "IMPROPER" : "DIHEDRALS", more)));
    std::vector<double> found;
    for (const Dihedral& dihedral : topology.dihedrals) found.push_back(dihedral.k);
    for (const Improper& improper : topology.impropers) found.push_back(improper.k);
    return found;
}

}  // namespace

TEST_CASE("bonds, angles and Urey-Bradley terms get their numbers in either direction",
          "[charmm][topology]") {
    Connectivity chain = chain_of({"A", "B", "C", "D"});
    chain.angles = {{0, 1, 2}, {3, 2, 1}};

    const Topology topology = build_topology(
        chain, force_field_with("ANGLES\nC B A 50.0 90.0 20.0 2.5\nB C D 40.0 180.0\n"));

    CHECK(topology.charge == chain.charge);
    CHECK(topology.bonds.size() == 3);
    CHECK(topology.bonds[0].k == 100);
    CHECK(topology.bonds[0].r0 == 1.5);
    REQUIRE(topology.angles.size() == 2);
    CHECK(topology.angles[0].theta0 == Approx(std::numbers::pi / 2));
    CHECK(topology.angles[1].k == 40);
    REQUIRE(topology.urey_bradleys.size() == 1);
    CHECK(topology.urey_bradleys[0].a == 0);
    CHECK(topology.urey_bradleys[0].c == 2);
    CHECK(topology.urey_bradleys[0].k == 20);
    CHECK(topology.urey_bradleys[0].s0 == 2.5);
    CHECK(topology.exclusions.pairs14 == std::vector<std::array<std::uint32_t, 2>>{{0, 3}});
}

TEST_CASE("a dihedral's own types come before wildcards, wherever they stand",
          "[charmm][topology]") {
    CHECK(constants("X B C X 9.0 1 0.0\nA B C D 1.0 1 0.0\n", false) == std::vector<double>{1});
    CHECK(constants("D C B A 1.0 1 0.0\nX B C X 9.0 1 0.0\n", false) == std::vector<double>{1});
    CHECK(constants("X C B X 9.0 1 0.0\n", false) == std::vector<double>{9});
    // Several multiplicities are as many terms, and those that are nothing none.
    CHECK(constants("A B C D 1.0 1 0.0\nA B C D 2.0 2 0.0\nD C B A 3.0 3 0.0\nA B C D 0.0 4 0.0\n",
                    false) == std::vector<double>{1, 2, 3});
}

TEST_CASE("an improper takes CHARMM's forms in CHARMM's order", "[charmm][topology]") {
    // Each form at either end where that differs; the last ones win as the earlier ones go.
    const std::vector<std::string> forms{"A B C D 1.0 0 0.0\n", "D X X A 2.0 0 0.0\n",
                                         "X B C D 3.0 0 0.0\n", "X C B X 4.0 0 0.0\n",
                                         "X X C D 5.0 0 0.0\n"};
    for (std::size_t first = 0; first < forms.size(); ++first) {
        std::string text;
        for (std::size_t i = forms.size(); i-- > first;) text += forms[i];
        CHECK(constants(text, true) == std::vector<double>{static_cast<double>(first + 1)});
    }
    CHECK(constants("X C B A 6.0 0 0.0\n", true) == std::vector<double>{6});
    CHECK(constants("X X B A 7.0 0 0.0\n", true) == std::vector<double>{7});
    // Another order of the middle atoms is another improper.
    CHECK(load_error_of([] { constants("A C B D 1.0 0 0.0\n", true); }) ==
          "s.psf:1: no improper parameters for A B C D");
}

TEST_CASE("a dihedral over a straight angle needs no parameters", "[charmm][topology]") {
    CHECK(constants("E E E E 1.0 1 0.0\nANGLES\nB C D 20.0 180.0\n", false).empty());
    CHECK(constants("E E E E 1.0 1 0.0\nANGLES\nC B A 20.0 180.0\n", false).empty());
    // What a file gives all the same counts.
    CHECK(constants("A B C D 1.0 1 0.0\nANGLES\nB C D 20.0 180.0\n", false) ==
          std::vector<double>{1});
    CHECK(load_error_of([] {
              constants("E E E E 1.0 1 0.0\nANGLES\nB C D 20.0 179.0\n", false);
          }) == "s.psf:1: no dihedral parameters for A B C D");
}

TEST_CASE("n = 0 is harmonic and n > 0 a cosine, in either section", "[charmm][topology]") {
    Connectivity chain = chain_of({"A", "B", "C", "D"});
    chain.dihedrals = {{0, 1, 2, 3}};
    chain.impropers = {{3, 2, 1, 0}};

    const Topology topology = build_topology(
        chain, force_field_with("DIHEDRALS\nA B C D 1.0 0 90.0\nIMPROPER\nA B C D 2.0 2 180.0\n"));

    REQUIRE(topology.impropers.size() == 1);
    CHECK(topology.impropers[0].k == 1);
    CHECK(topology.impropers[0].psi0 == Approx(std::numbers::pi / 2));
    REQUIRE(topology.dihedrals.size() == 1);
    CHECK(topology.dihedrals[0].a == 3);
    CHECK(topology.dihedrals[0].multiplicity == 2);
    CHECK(topology.dihedrals[0].phase == Approx(std::numbers::pi));
}

TEST_CASE("a dihedral that recurs counts once", "[charmm][topology]") {
    Connectivity chain = chain_of({"A", "B", "C", "D"});
    chain.dihedrals = {{0, 1, 2, 3}, {0, 1, 2, 3}, {3, 2, 1, 0}};

    CHECK(build_topology(chain, force_field_with("DIHEDRALS\nA B C D 1.0 1 0.0\n"))
              .dihedrals.size() == 1);
}

TEST_CASE("pairs three bonds apart have 1-4 numbers, and NBFIX its own", "[charmm][topology]") {
    const Connectivity chain = chain_of({"A", "2", "C", "4"});

    const Topology topology = build_topology(
        chain, force_field_with("NBFIX\nD A -0.5 3.0\nB C -0.6 3.1 -0.7 3.2\nA ZZ -0.5 3.0\n"));

    const auto plain = [&](std::size_t a, std::size_t b) {
        return topology.lennard_jones.row(topology.type[a])[topology.type[b]];
    };
    const auto special = [&](std::size_t a, std::size_t b) {
        return topology.lennard_jones14.row(topology.type[a])[topology.type[b]];
    };
    CHECK(plain(0, 1).epsilon == Approx(0.1));
    CHECK(plain(0, 1).rmin == 4.0);
    CHECK(special(0, 1).epsilon == Approx(0.2));  // sqrt(0.4 * 0.1)
    CHECK(special(0, 1).rmin == 3.5);
    CHECK(special(1, 1).rmin == 4.0);
    CHECK(plain(0, 3).epsilon == 0.5);
    CHECK(special(3, 0).rmin == 3.0);
    CHECK(plain(2, 1).rmin == 3.1);
    CHECK(special(1, 2).epsilon == 0.7);
}

TEST_CASE("a cross-term finds the map of its eight types", "[charmm][topology]") {
    std::string map = "CMAP\nA B C D B C D A 2\n0.0 1.0\n2.0 3.0\n";
    Connectivity chain = chain_of({"A", "B", "C", "D"});
    chain.type.push_back("A");
    chain.names.push_back({"P", "R", "1", "X4"});
    chain.charge.push_back(0);
    chain.mass.push_back(12);
    chain.lines.push_back(5);
    chain.cmaps = {{0, 1, 2, 3, 1, 2, 3, 4}, {0, 1, 2, 3, 1, 2, 3, 4}};

    const Topology topology = build_topology(chain, force_field_with(map));

    REQUIRE(topology.cmap_terms.size() == 2);
    CHECK(topology.cmap_maps.size() == 1);
    CHECK(topology.cmap_maps[0].points[2].energy == 2.0);
    CHECK(topology.cmap_terms[1].psi == std::array<std::uint32_t, 4>{1, 2, 3, 4});
}

TEST_CASE("all parameters that are missing are told at once, with near ones",
          "[charmm][topology]") {
    Connectivity chain = chain_of({"A", "B", "C", "C"});
    chain.angles = {{0, 1, 2}, {1, 2, 3}};
    chain.dihedrals = {{0, 1, 2, 3}};

    CHECK(load_error_of([&] {
              build_topology(chain, force_field_with("ANGLES\nA B D 1.0 90.0\n"
                                                     "DIHEDRALS\nD C B A 1.0 1 0.0\n"));
          }) ==
          "s.psf:3: no bond parameters for C C; did you mean 'B C'?; s.psf:1: no angle parameters "
          "for A B C; did you mean 'A B D'?; s.psf:2: no angle parameters for B C C; s.psf:1: no "
          "dihedral parameters for A B C C; did you mean 'A B C D'?");
    CHECK(load_error_of([&] { build_topology(chain_of({"A", "E", "7"}), force_field_with("")); }) ==
          "s.psf:2: unknown atom type 'E': no MASS line; s.psf:3: no atom type has the "
          "number 7; expected a topology file whose MASS lines number the types");
}

TEST_CASE("unknown types, bonded and non-bonded numbers and maps are told in one error",
          "[charmm][topology]") {
    ForceField force_field = force_field_with("");
    force_field.nonbonded.erase("C");
    Connectivity chain = chain_of({"A", "B", "C", "E", "C"});
    chain.angles = {{0, 1, 2}, {1, 2, 3}};  // one with an unknown type follows from that
    chain.cmaps = {{0, 1, 2, 4, 1, 2, 4, 0}};

    CHECK(
        load_error_of([&] { build_topology(chain, force_field); }) ==
        "s.psf:3: atom type 'C' has no NONBONDED parameters in a.rtf, a.prm; s.psf:4: unknown atom "
        "type 'E': no MASS line; s.psf:1: no angle parameters for A B C; s.psf:1: no CMAP "
        "parameters for A B C C B C C A");
}

TEST_CASE("a topology alone has no parameters", "[charmm][topology]") {
    const ForceField force_field = force_field_of("MASS 1 A 12.0 C\nMASS 2 B 12.0 C\n");

    CHECK(load_error_of([&] { build_topology(chain_of({"A", "B"}), force_field); }) ==
          "s.psf:1: no NONBONDED parameters in a.rtf; expected a parameter file (.prm) beside the "
          "topology");
    CHECK(load_error_of([&] { build_topology(chain_of({"A", "B"}), {}); }) ==
          "s.psf:1: no atom types in ; expected a file with MASS lines");
    const ForceField unnumbered = force_field_of("MASS -1 A 12.0 C\n");
    CHECK(load_error_of([&] { build_topology(chain_of({"56", "2"}), unnumbered); }) ==
          "s.psf:1: atom types are given as numbers, but no MASS line in a.rtf has a number; "
          "expected the topology file that numbers the types");
}
