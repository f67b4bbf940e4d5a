#include "ligands/match.h"

#include "tests/ligands/molecules.h"

#include <catch2/catch.hpp>

using namespace palpa;
using test::build_graph;

TEST_CASE("atoms are matched by names", "[ligands][match]") {
    const MoleculeGraph known = build_graph({"C", "C", "O"}, {{0, 1, 1}, {1, 2, 1}});
    MoleculeGraph found = build_graph({"O", "C", "C"}, {});
    found.atoms[0].name = "O3";
    found.atoms[1].name = "C2";
    found.atoms[2].name = "C1";

    CHECK(match_atoms(known, found) == std::vector<std::uint32_t>{2, 1, 0});
}

TEST_CASE("atoms without common names are matched by elements and bonds", "[ligands][match]") {
    // Isopropanol's O and methyls around the middle, then a chain that ends in N.
    const MoleculeGraph known =
        build_graph({"C", "C", "C", "O", "N"}, {{0, 1, 1}, {1, 2, 1}, {1, 3, 1}, {2, 4, 1}});
    MoleculeGraph found =
        build_graph({"N", "O", "C", "C", "C"}, {{0, 2, 1}, {2, 3, 1}, {3, 1, 1}, {3, 4, 1}});
    for (GraphAtom& atom : found.atoms) atom.name += "X";

    CHECK(match_atoms(known, found) == std::vector<std::uint32_t>{4, 3, 2, 1, 0});

    SECTION("also where the structure lacks some") {
        std::vector<bool> left_out(5);
        left_out[4] = true;
        const auto match = match_atoms(known, without_atoms(found, left_out));
        CHECK(match == std::vector<std::uint32_t>{4, 3, 2, 1});
    }
    SECTION("but not where it has another bond") {
        found.bonds.push_back({1, 4, 1});
        CHECK_FALSE(match_atoms(known, found));
    }
}
