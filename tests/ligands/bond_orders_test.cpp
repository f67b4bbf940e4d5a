#include "ligands/bond_orders.h"

#include "ligands/add_hydrogens.h"
#include "ligands/model_compounds.h"
#include "tests/ligands/molecules.h"
#include "tests/support/shared_data.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

using namespace palpa;
using test::build_graph;
using test::build_ring;

namespace {

// The same molecule with hydrogens, orders and charges forgotten.
MoleculeGraph without_orders(const MoleculeGraph& graph) {
    MoleculeGraph bare = with_hydrogens(graph);
    for (GraphBond& bond : bare.bonds) bond.order = 1;
    for (GraphAtom& atom : bare.atoms) atom.charge = 0;
    return bare;
}

int sum_of_orders(const MoleculeGraph& graph, const std::string& element) {
    int sum = 0;
    for (const GraphBond& bond : graph.bonds) {
        if (graph.atoms[bond.a].element == element || graph.atoms[bond.b].element == element) {
            sum += bond.order;
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("hydrogens and bonds say which bonds are double", "[ligands][orders]") {
    SECTION("a chain of conjugated bonds") {
        const MoleculeGraph butadiene =
            build_graph({"C", "C", "C", "C"}, {{0, 1, 2}, {1, 2, 1}, {2, 3, 2}});
        MoleculeGraph bare = without_orders(butadiene);
        REQUIRE(assign_bond_orders(bare));
        for (std::size_t i = 0; i < 3; ++i) CHECK(bare.bonds[i].order == butadiene.bonds[i].order);
    }
    SECTION("two rings that share a bond, each in two ways") {
        MoleculeGraph azulene =
            build_ring(std::vector<std::string>(10, "C"), {2, 1, 2, 1, 2, 1, 2, 1, 2, 1});
        azulene.bonds.push_back({0, 4, 1});
        MoleculeGraph bare = without_orders(azulene);
        REQUIRE(assign_bond_orders(bare));
        CHECK(total_charge(bare) == 0);
    }
    SECTION("a nitrile") {
        MoleculeGraph bare = without_orders(build_graph({"C", "C", "N"}, {{0, 1, 1}, {1, 2, 3}}));
        REQUIRE(assign_bond_orders(bare));
        CHECK(bare.bonds[1].order == 3);
    }
    SECTION("a nitro group") {
        MoleculeGraph bare =
            without_orders(build_graph({"C", "N", "O", "O"}, {{0, 1, 1}, {1, 2, 2}, {1, 3, 2}}));
        REQUIRE(assign_bond_orders(bare));
        CHECK(bare.atoms[1].charge == 1);
        CHECK(total_charge(bare) == 0);
        CHECK(sum_of_orders(bare, "N") == 4);
    }
}

TEST_CASE("a missing proton is a charge", "[ligands][orders]") {
    SECTION("of an acid") {
        MoleculeGraph acetate =
            build_graph({"C", "C", "O", "O"}, {{0, 1, 1}, {1, 2, 2}, {1, 3, 1}});
        acetate.atoms[3].charge = -1;
        MoleculeGraph bare = without_orders(acetate);
        REQUIRE(assign_bond_orders(bare));
        CHECK(total_charge(bare) == -1);
        CHECK(bare.atoms[2].charge + bare.atoms[3].charge == -1);
    }
    SECTION("and one too many, of guanidine") {
        MoleculeGraph cation = build_graph({"C", "N", "N", "N"}, {{0, 1, 2}, {0, 2, 1}, {0, 3, 1}});
        cation.atoms[1].charge = 1;
        MoleculeGraph bare = without_orders(cation);
        REQUIRE(assign_bond_orders(bare));
        CHECK(total_charge(bare) == 1);
        CHECK(sum_of_orders(bare, "C") == 4);
    }
    SECTION("of pyridine, far from the carbon that is left over") {
        MoleculeGraph cation = build_ring({"N", "C", "C", "C", "C", "C"}, {2, 1, 2, 1, 2, 1});
        cation.atoms[0].charge = 1;
        MoleculeGraph bare = without_orders(cation);
        REQUIRE(assign_bond_orders(bare));
        CHECK(bare.atoms[0].charge == 1);
        CHECK(total_charge(bare) == 1);
    }
}

TEST_CASE("a radical is refused", "[ligands][orders]") {
    MoleculeGraph methyl = build_graph({"C", "H", "H", "H"}, {{0, 1, 1}, {0, 2, 1}, {0, 3, 1}});
    CHECK_FALSE(assign_bond_orders(methyl));
}

// The charges that RESI lines state are the authors', and know nothing of bond orders.
TEST_CASE("valences of CGenFF's model compounds add up to their charges", "[ligands][orders]") {
    const auto folder = test::find_shared_data("data/charmm");
    if (!folder) return;
    const ForceField force_field = read_force_field(std::vector{*folder / "top_all36_cgenff.rtf"});

    std::size_t all = 0;
    for (const auto& [name, residue] : force_field.residues) {
        if (residue.atoms.size() > 1) ++all;
    }
    const std::vector<ModelCompound> compounds = find_model_compounds(force_field);

    // 17 do not: boronates, whose types are others, a thiophosphate, and the like.
    REQUIRE(all > 930);
    CHECK(compounds.size() >= 915);
}
