#include "ligands/perception.h"

#include "ligands/add_hydrogens.h"
#include "ligands/environments.h"
#include "tests/ligands/molecules.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;
using test::build_graph;
using test::build_ring;

namespace {

MoleculeGraph naphthalene() {
    MoleculeGraph graph =
        build_ring(std::vector<std::string>(10, "C"), {2, 1, 2, 1, 2, 1, 2, 1, 2, 1});
    graph.bonds.push_back({0, 5, 1});
    return with_hydrogens(graph);
}

}  // namespace

TEST_CASE("rings of 4n + 2 pi electrons are aromatic", "[ligands][perception]") {
    struct Case {
        std::string name;
        MoleculeGraph graph;
        bool aromatic;
    };
    const auto given = GENERATE_COPY(values<Case>(
        {{"benzene", build_ring(std::vector<std::string>(6, "C"), {2, 1, 2, 1, 2, 1}), true},
         {"pyrrole", build_ring({"N", "C", "C", "C", "C"}, {1, 2, 1, 2, 1}), true},
         {"thiophene", build_ring({"S", "C", "C", "C", "C"}, {1, 2, 1, 2, 1}), true},
         {"cyclopentadiene", build_ring({"C", "C", "C", "C", "C"}, {1, 2, 1, 2, 1}), false},
         {"cyclohexene", build_ring(std::vector<std::string>(6, "C"), {2, 1, 1, 1, 1, 1}), false},
         {"1,4-dioxin", build_ring({"O", "C", "C", "O", "C", "C"}, {1, 2, 1, 1, 2, 1}), false}}));
    INFO(given.name);

    const Perceived seen = perceive(with_hydrogens(given.graph));

    REQUIRE(seen.rings.size() == 1);
    CHECK(seen.ring_is_aromatic[0] == given.aromatic);
    CHECK((seen.kinds[0] == BondKind::Aromatic) == given.aromatic);
}

TEST_CASE("naphthalene has two rings of six", "[ligands][perception]") {
    const Perceived seen = perceive(naphthalene());
    REQUIRE(seen.rings.size() == 2);
    CHECK(seen.rings[0].size() == 6);
    CHECK(seen.ring_is_aromatic[0]);
    CHECK(seen.ring_is_aromatic[1]);
}

TEST_CASE("surroundings do not depend on the Kekulé form or on the order of atoms",
          "[ligands][perception]") {
    const MoleculeGraph toluene = [] {
        MoleculeGraph graph = build_ring(std::vector<std::string>(6, "C"), {2, 1, 2, 1, 2, 1});
        graph.atoms.push_back({"C7", "C", 0, std::nullopt});
        graph.bonds.push_back({0, 6, 1});
        return graph;
    }();
    MoleculeGraph other = toluene;
    for (std::size_t i = 0; i < 6; ++i) other.bonds[i].order = 3 - other.bonds[i].order;
    // The same molecule backwards.
    MoleculeGraph backwards = toluene;
    std::reverse(backwards.atoms.begin(), backwards.atoms.end());
    for (GraphBond& bond : backwards.bonds) {
        bond.a = 6 - bond.a;
        bond.b = 6 - bond.b;
    }
    const auto keys_of = [](const MoleculeGraph& graph) {
        const MoleculeGraph full = with_hydrogens(graph);
        return find_environments(full, perceive(full));
    };

    const auto keys = keys_of(toluene);

    const auto other_keys = keys_of(other), back = keys_of(backwards);
    for (std::size_t i = 0; i < 7; ++i) {
        CHECK(keys[i] == other_keys[i]);
        CHECK(keys[i] == back[6 - i]);
    }
    // Mirror images of the ring are alike, ortho and meta are not.
    CHECK(keys[1] == keys[5]);
    CHECK(keys[1] != keys[2]);
}

TEST_CASE("both oxygens of a carboxylate are alike", "[ligands][perception]") {
    MoleculeGraph acetate = build_graph({"C", "C", "O", "O"}, {{0, 1, 1}, {1, 2, 2}, {1, 3, 1}});
    acetate.atoms[3].charge = -1;
    const MoleculeGraph full = with_hydrogens(acetate);

    const Perceived seen = perceive(full);

    CHECK(seen.charge[2] == Approx(-0.5));
    CHECK(seen.charge[3] == Approx(-0.5));
    const auto keys = find_environments(full, seen);
    CHECK(keys[2] == keys[3]);
}
