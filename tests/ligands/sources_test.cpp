#include "ligands/sources.h"

#include "formats/structure.h"
#include "ligands/orders_of_places.h"
#include "ligands/perception.h"
#include "ligands/sdf.h"
#include "tests/ligands/molecules.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

using namespace palpa;
using test::count_element;

namespace {

// The ligand of an entry.
std::optional<MoleculeGraph> read_ligand(const std::string& file) {
    const auto path = test::find_shared_data("data/hiv/" + file);
    if (!path) return std::nullopt;
    const Structure structure = read_structure(*path);
    MoleculeGraph graph;
    graph.name = structure.names.front().residue;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        graph.atoms.push_back(
            {structure.names[i].atom, structure.records[i].element, 0, structure.positions[i]});
    }
    return graph;
}

}  // namespace

// Formulae of the Chemical Component Dictionary, hydrogens included.
TEST_CASE("places of atoms alone say what a drug is", "[ligands][sources]") {
    struct Case {
        std::string file, name;
        std::size_t atoms, hydrogens;
        int charge;
    };
    const auto given = GENERATE(values<Case>({
        {"1hpv_ligand.pdb", "amprenavir, C25 H35 N3 O6 S", 70, 35, 0},
        {"1hsg_ligand.pdb", "indinavir, C36 H47 N5 O4", 92, 47, 0},
        {"1hvr_ligand.pdb", "XK263, C41 H38 N2 O3", 84, 38, 0},
        {"1hxw_ligand.pdb", "ritonavir, C37 H48 N6 O5 S2", 98, 48, 0},
        {"4k4p_ligand.pdb", "TL-3, C50 H64 N6 O10", 130, 64, 0},
    }));
    const auto graph = read_ligand(given.file);
    if (!graph) return;
    INFO(given.name);

    const FoundLigand found = find_ligand({*graph, {}, {}, {}});

    CHECK(found.source.find("positions") != std::string::npos);
    CHECK(found.graph.size() == given.atoms);
    CHECK(count_element(found.graph, "H") == given.hydrogens);
    CHECK(total_charge(found.graph) == given.charge);
}

TEST_CASE("orders from places are those that the archive gives", "[ligands][sources]") {
    const auto path = test::find_shared_data("data/hiv/2p3b_3TL.sdf");
    if (!path) return;
    const LigandFile file = read_ligand_file(*path);
    MoleculeGraph guessed = file.graph;
    find_bonds(guessed);
    REQUIRE(guessed.bonds.size() == file.graph.bonds.size());

    guess_orders(guessed);

    // Kekulé forms may differ: aromatic bonds are compared as such.
    const Perceived right = perceive(file.graph), made = perceive(guessed);
    for (std::size_t i = 0; i < guessed.bonds.size(); ++i) {
        for (std::size_t j = 0; j < file.graph.bonds.size(); ++j) {
            const GraphBond &a = guessed.bonds[i], &b = file.graph.bonds[j];
            if (!((a.a == b.a && a.b == b.b) || (a.a == b.b && a.b == b.a))) continue;
            INFO("atoms " << a.a + 1 << " and " << a.b + 1);
            CHECK(made.kinds[i] == right.kinds[j]);
        }
    }
}

TEST_CASE("a ligand's file without names gives its hydrogens to the structure's atoms",
          "[ligands][sources]") {
    const auto graph = read_ligand("4k4q_ligand.pdb");
    const auto file = test::find_shared_data("data/hiv/2p3b_3TL.sdf");
    if (!graph || !file) return;

    const FoundLigand found = find_ligand({*graph, {*file}, {}, {}});

    CHECK(found.file == *file);
    CHECK(found.graph.size() == 130);
    CHECK(total_charge(found.graph) == 0);
    std::size_t placed = 0;
    for (const GraphAtom& atom : found.graph.atoms) placed += atom.position ? 1 : 0;
    CHECK(placed == 66);
    for (const GraphAtom& atom : graph->atoms) {
        const auto same = [&](const GraphAtom& other) {
            return other.name == atom.name && other.element == atom.element;
        };
        CHECK(std::any_of(found.graph.atoms.begin(), found.graph.atoms.end(), same));
    }
}

TEST_CASE("a file of another molecule is passed over", "[ligands][sources]") {
    const auto graph = read_ligand("1hsg_ligand.pdb");
    const auto file = test::find_shared_data("data/hiv/2p3b_3TL.sdf");
    if (!graph || !file) return;

    CHECK_FALSE(find_ligand({*graph, {*file}, {}, {}}).file);
}

TEST_CASE("a molecule with all its hydrogens needs nothing else", "[ligands][sources]") {
    // Ethylammonium, ideal places.
    MoleculeGraph graph;
    graph.name = "ETA";
    const auto add = [&](const char* name, const char* element, double x, double y, double z) {
        graph.atoms.push_back({name, element, 0, Vec3(x, y, z)});
    };
    add("C1", "C", 0, 0, 0);
    add("C2", "C", 1.53, 0, 0);
    add("N", "N", 2.03, 1.41, 0);
    add("H11", "H", -0.36, 1.03, 0);
    add("H12", "H", -0.36, -0.51, 0.89);
    add("H13", "H", -0.36, -0.51, -0.89);
    add("H21", "H", 1.89, -0.51, 0.89);
    add("H22", "H", 1.89, -0.51, -0.89);
    add("HN1", "H", 1.69, 1.90, 0.83);
    add("HN2", "H", 1.69, 1.90, -0.83);
    add("HN3", "H", 3.05, 1.41, 0);

    const FoundLigand found = find_ligand({graph, {}, {}, {}});

    CHECK(found.source == "the structure's own hydrogens");
    CHECK(found.graph.size() == 11);
    CHECK(total_charge(found.graph) == 1);
    CHECK(found.graph.atoms[2].charge == 1);
}
