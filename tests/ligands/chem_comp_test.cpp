#include "ligands/chem_comp.h"

#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <string>

using namespace palpa;

namespace {

// As the archive writes it, beside another residue; as monomer libraries do.
const std::string archive =
    "data_1ABC\n"
    "loop_\n"
    "_chem_comp_atom.comp_id\n_chem_comp_atom.atom_id\n_chem_comp_atom.type_symbol\n"
    "GLY N N\nACT C C\nACT O O\nACT OXT O\nACT CH3 C\n"
    "loop_\n"
    "_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n_chem_comp_bond.atom_id_2\n"
    "_chem_comp_bond.value_order\n"
    "GLY N CA sing\nACT C O doub\nACT C OXT sing\nACT C CH3 sing\n";
const std::string library =
    "data_comp_ACT\n"
    "loop_\n"
    "_chem_comp_atom.comp_id\n_chem_comp_atom.atom_id\n_chem_comp_atom.type_symbol\n"
    "_chem_comp_atom.x\n_chem_comp_atom.y\n_chem_comp_atom.z\n"
    "ACT C C 0 0 0\nACT O O 1.2 0 0\nACT OXT O -0.6 1.0 0\nACT CH3 C -0.7 -1.3 0\n"
    "loop_\n"
    "_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n_chem_comp_bond.atom_id_2\n"
    "_chem_comp_bond.type\n"
    "ACT C O deloc\nACT C OXT deloc\nACT C CH3 single\n";

}  // namespace

TEST_CASE("an entry's bonds are read, of one residue", "[ligands][cif]") {
    const auto file = find_chem_comp(archive, "1abc.cif", "ACT");

    REQUIRE(file);
    REQUIRE(file->graph.size() == 4);
    CHECK(file->graph.atoms[1].name == "O");
    CHECK(file->graph.atoms[1].element == "O");
    REQUIRE(file->graph.bonds.size() == 3);
    CHECK(file->graph.bonds[0].order == 2);
    CHECK_FALSE(file->open_bonds[0]);
    CHECK_FALSE(find_chem_comp(archive, "1abc.cif", "ATP"));
}

TEST_CASE("a monomer library's delocalised bonds are open", "[ligands][cif]") {
    const auto file = find_chem_comp(library, "ACT.cif", "ACT");

    REQUIRE(file);
    CHECK(file->open_bonds == std::vector<bool>{true, true, false});
    REQUIRE(file->graph.atoms[1].position);
    CHECK(file->graph.atoms[1].position->x() == 1.2);
}

TEST_CASE("an element that is none is named with its line", "[ligands][cif]") {
    const std::string text = library.substr(0, library.find("ACT O O")) + "ACT O Qq 0 0 0\n";
    CHECK(test::load_error_of([&] { (void)find_chem_comp(text, "ACT.cif", "ACT"); }) ==
          "ACT.cif:10:1: atom O: 'QQ' is not an element; expected a symbol such as C");
}
