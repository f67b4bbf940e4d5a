#include "ligands/sdf.h"

#include "tests/ligands/molecules.h"
#include "tests/support/load_error_of.h"
#include "tests/support/replaced.h"

#include <catch2/catch.hpp>
#include <string>

using namespace palpa;
using test::load_error_of;
using test::replaced;

namespace {

// Acetate, by hand after the CTfile formats of BIOVIA (2020).
const std::string acetate_v2000 =
    "acetate\n"
    "  by hand\n"
    "\n"
    "  4  3  0  0  0  0            999 V2000\n"
    "    0.0000    0.0000    0.0000 C   0  0\n"
    "    1.5000    0.0000    0.0000 C   0  0\n"
    "    2.1000    1.1000    0.0000 O   0  0\n"
    "    2.1000   -1.1000    0.0000 O   0  0\n"
    "  1  2  1  0\n"
    "  2  3  2  0\n"
    "  2  4  1  0\n"
    "M  CHG  1   4  -1\n"
    "M  END\n"
    "$$$$\n";

const std::string acetate_v3000 =
    "acetate\n"
    "  by hand\n"
    "\n"
    "  0  0  0     0  0            999 V3000\n"
    "M  V30 BEGIN CTAB\n"
    "M  V30 COUNTS 4 3 0 0 0\n"
    "M  V30 BEGIN ATOM\n"
    "M  V30 1 C 0 0 0 0\n"
    "M  V30 2 C 1.5 0 0 0\n"
    "M  V30 3 O 2.1 1.1 0 0\n"
    "M  V30 4 O 2.1 -1.1 0 0 CHG=-1\n"
    "M  V30 END ATOM\n"
    "M  V30 BEGIN BOND\n"
    "M  V30 1 1 1 2\n"
    "M  V30 2 2 2 3\n"
    "M  V30 3 1 2 4\n"
    "M  V30 END BOND\n"
    "M  V30 END CTAB\n"
    "M  END\n";

const std::string acetate_mol2 =
    "# by hand\n"
    "@<TRIPOS>MOLECULE\n"
    "acetate\n"
    "4 3\n"
    "SMALL\n"
    "NO_CHARGES\n"
    "@<TRIPOS>ATOM\n"
    "1 C1 0.0 0.0 0.0 C.3\n"
    "2 C2 1.5 0.0 0.0 C.2\n"
    "3 O1 2.1 1.1 0.0 O.co2\n"
    "4 O2 2.1 -1.1 0.0 O.co2\n"
    "@<TRIPOS>BOND\n"
    "1 1 2 1\n"
    "2 2 3 ar\n"
    "3 2 4 ar\n";

std::string message_of_sdf(const std::string& text) {
    return load_error_of([&] { (void)parse_sdf(text, "a.sdf"); });
}

std::string message_of_mol2(const std::string& text) {
    return load_error_of([&] { (void)parse_mol2(text, "a.mol2"); });
}

}  // namespace

TEST_CASE("an SDF file of either version is read", "[ligands][sdf]") {
    const LigandFile file =
        parse_sdf(GENERATE_REF(as<std::string>(), acetate_v2000, acetate_v3000), "a.sdf");

    REQUIRE(file.graph.size() == 4);
    CHECK(file.graph.name == "acetate");
    CHECK(file.graph.atoms[3].element == "O");
    CHECK(file.graph.atoms[3].charge == -1);
    CHECK(file.states_charges);
    REQUIRE(file.graph.atoms[2].position);
    CHECK(file.graph.atoms[2].position->y() == 1.1);
    REQUIRE(file.graph.bonds.size() == 3);
    CHECK(file.graph.bonds[1].order == 2);
    CHECK(file.open_bonds == std::vector<bool>{false, false, false});
}

TEST_CASE("a MOL2 file is read, with bonds that it leaves open", "[ligands][sdf]") {
    const LigandFile file = parse_mol2(acetate_mol2, "a.mol2");

    REQUIRE(file.graph.size() == 4);
    CHECK(file.names_atoms);
    CHECK(file.graph.atoms[2].name == "O1");
    CHECK(file.graph.atoms[2].element == "O");
    CHECK(file.open_bonds == std::vector<bool>{false, true, true});
}

TEST_CASE("what is wrong in a ligand's file is named with its line", "[ligands][sdf]") {
    CHECK(message_of_sdf("a\n") ==
          "a.sdf:1: the file ends here; expected a line about the program");
    CHECK(message_of_sdf(replaced(acetate_v2000, "  4  3  0", "  x  3  0")) ==
          "a.sdf:4: 'x' is not a whole number; expected the number of atoms");
    CHECK(message_of_sdf(replaced(acetate_v2000, "1.5000", "1.5e99")).find("a.sdf:6: ") == 0);
    CHECK(message_of_sdf(
              replaced(acetate_v2000, "O   0  0\n    2.1000   -", "Qq  0  0\n    2.1000   -")) ==
          "a.sdf:7: 'Qq' is not an element; expected a symbol such as C or Cl");
    CHECK(message_of_sdf(replaced(acetate_v2000, "  2  4  1", "  2  9  1")) ==
          "a.sdf:11: a bond of atoms 2 and 9; expected two different atoms from 1 to 4");
    CHECK(message_of_sdf(replaced(acetate_v2000, "  2  4  1", "  2  3  1")) ==
          "a.sdf:11: the bond of atoms 2 and 3 is repeated");
    CHECK(message_of_sdf(replaced(acetate_v2000, "  2  3  2", "  2  3  7")) ==
          "a.sdf:10: a bond of kind 7; expected 1, 2, 3 or 4 (aromatic)");
    CHECK(message_of_sdf(replaced(acetate_v2000, "M  END\n$$$$\n", "")) ==
          "a.sdf:12: the file ends here; expected M  END");
    CHECK(message_of_sdf(replaced(acetate_v3000, "COUNTS 4 3", "COUNTS 5 3")) ==
          "a.sdf:19: 4 atoms and 3 bonds; expected 5 and 3");
    CHECK(message_of_mol2(replaced(acetate_mol2, "3 2 4 ar", "3 2 4 xx")) ==
          "a.mol2:15: a bond of kind 'xx'; expected 1, 2, 3, am, ar or un");
    CHECK(message_of_mol2("@<TRIPOS>MOLECULE\nx\n") ==
          "a.mol2:2: the file has no atoms; expected a section @<TRIPOS>ATOM");
}
