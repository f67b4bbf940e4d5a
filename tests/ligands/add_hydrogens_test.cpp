#include "ligands/add_hydrogens.h"

#include "tests/ligands/molecules.h"

#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

using namespace palpa;
using test::build_graph;
using test::build_ring;
using test::count_element;

namespace {

// At pH 7.4, hydrogens included.
MoleculeGraph in_water(const MoleculeGraph& graph) {
    std::vector<std::string> notes;
    MoleculeGraph neutral = with_hydrogens(graph);
    charge_at_ph_7(neutral, notes);
    return with_hydrogens(neutral);
}

}  // namespace

TEST_CASE("valences say how many hydrogens there are", "[ligands][hydrogens]") {
    struct Case {
        std::string name;
        MoleculeGraph graph;
        std::size_t hydrogens;
    };
    const auto ring = [](std::vector<std::string> elements, std::vector<int> orders) {
        return build_ring(elements, orders);
    };
    // Formulae: C2H6O, C2H3N, C6H6, C5H5N, C4H5N, C3H4N2, CH3NO2, CH3SO2NH2, H3PO4.
    const auto given = GENERATE_COPY(values<Case>(
        {{"ethanol", build_graph({"C", "C", "O"}, {{0, 1, 1}, {1, 2, 1}}), 6},
         {"acetonitrile", build_graph({"C", "C", "N"}, {{0, 1, 1}, {1, 2, 3}}), 3},
         {"benzene", ring({"C", "C", "C", "C", "C", "C"}, {2, 1, 2, 1, 2, 1}), 6},
         {"pyridine", ring({"N", "C", "C", "C", "C", "C"}, {2, 1, 2, 1, 2, 1}), 5},
         {"pyrrole", ring({"N", "C", "C", "C", "C"}, {1, 2, 1, 2, 1}), 5},
         {"imidazole", ring({"N", "C", "N", "C", "C"}, {1, 2, 1, 2, 1}), 4},
         {"nitromethane", build_graph({"C", "N", "O", "O"}, {{0, 1, 1}, {1, 2, 2}, {1, 3, 2}}), 3},
         {"methanesulphonamide",
          build_graph({"C", "S", "O", "O", "N"}, {{0, 1, 1}, {1, 2, 2}, {1, 3, 2}, {1, 4, 1}}), 5},
         {"phosphoric acid",
          build_graph({"P", "O", "O", "O", "O"}, {{0, 1, 2}, {0, 2, 1}, {0, 3, 1}, {0, 4, 1}}),
          3}}));
    INFO(given.name);

    const MoleculeGraph full = with_hydrogens(given.graph);

    CHECK(count_element(full, "H") == given.hydrogens);
    CHECK(total_charge(full) == 0);
    std::set<std::string> names;
    for (const GraphAtom& atom : full.atoms) CHECK(names.insert(atom.name).second);
}

TEST_CASE("acids and bases are charged as in water at pH 7.4", "[ligands][hydrogens]") {
    struct Case {
        std::string name;
        MoleculeGraph graph;
        int charge;  // as measured pKa values say
    };
    const MoleculeGraph aniline = [] {
        MoleculeGraph graph = build_ring({"C", "C", "C", "C", "C", "C"}, {2, 1, 2, 1, 2, 1});
        graph.atoms.push_back({"N7", "N", 0, std::nullopt});
        graph.bonds.push_back({0, 6, 1});
        return graph;
    }();
    const MoleculeGraph piperazine = build_ring({"N", "C", "C", "N", "C", "C"}, {1, 1, 1, 1, 1, 1});
    const MoleculeGraph morpholine = build_ring({"N", "C", "C", "O", "C", "C"}, {1, 1, 1, 1, 1, 1});
    const auto given = GENERATE_COPY(values<Case>(
        {// 4.8
         {"acetic acid", build_graph({"C", "C", "O", "O"}, {{0, 1, 1}, {1, 2, 2}, {1, 3, 1}}), -1},
         {"acetamide", build_graph({"C", "C", "O", "N"}, {{0, 1, 1}, {1, 2, 2}, {1, 3, 1}}), 0},
         {"ethylamine", build_graph({"C", "C", "N"}, {{0, 1, 1}, {1, 2, 1}}), 1},  // 10.7
         {"aniline", aniline, 0},                                                  // 4.6
         {"piperazine", piperazine, 1},                                            // 9.8 and 5.7
         {"morpholine", morpholine, 1},                                            // 8.4
         {"guanidine", build_graph({"C", "N", "N", "N"}, {{0, 1, 2}, {0, 2, 1}, {0, 3, 1}}), 1},
         {"acetamidine", build_graph({"C", "C", "N", "N"}, {{0, 1, 1}, {1, 2, 2}, {1, 3, 1}}), 1},
         // 5.7
         {"trifluoroethylamine",
          build_graph({"N", "C", "C", "F", "F", "F"},
                      {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {2, 4, 1}, {2, 5, 1}}),
          0},
         {"methyl phosphate",
          build_graph({"C", "O", "P", "O", "O", "O"},
                      {{0, 1, 1}, {1, 2, 1}, {2, 3, 2}, {2, 4, 1}, {2, 5, 1}}),
          -2},
         {"glycine",
          build_graph({"N", "C", "C", "O", "O"}, {{0, 1, 1}, {1, 2, 1}, {2, 3, 2}, {2, 4, 1}}),
          0}}));
    INFO(given.name);

    CHECK(total_charge(in_water(given.graph)) == given.charge);
}

TEST_CASE("hydrogens keep the names that a heavy atom's had", "[ligands][hydrogens]") {
    MoleculeGraph graph = build_graph({"C", "O", "H"}, {{0, 1, 1}, {1, 2, 1}});
    graph.atoms[2].name = "HO1";

    const MoleculeGraph full = with_hydrogens(graph);

    REQUIRE(full.size() == 6);
    const BondLists bonds = bonds_of_atoms(full);
    REQUIRE(bonds[1].size() == 2);
    CHECK(full.atoms[other_end(full.bonds[bonds[1][1]], 1)].name == "HO1");
}
