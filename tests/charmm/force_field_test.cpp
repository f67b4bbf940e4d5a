#include "charmm/force_field.h"

#include "tests/support/force_field_of.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;
using test::load_error_of;

namespace {

// The lines on TIP3P of CHARMM's toppar_water_ions.str, with what stands around them there.
constexpr std::string_view tip3p = R"(* Toplogy and parameter information for water and ions.
*

!set nothing here
set nat ?NATC
set app
if "@NAT" ne "?NATC" if @nat ne 0 set app append

read rtf card @app
* Topology for water and ions
*
31  1

MASS  -1  HT         1.00800 H ! TIPS3P WATER HYDROGEN
MASS  -1  OT        15.99940 O ! TIPS3P WATER OXYGEN

default first none last none
AUTO ANGLE DIHE

RESI TIP3         0.000 NOANG NODIH ! tip3p water model
GROUP
ATOM OH2  OT     -0.834
ATOM H1   HT      0.417
ATOM H2   HT      0.417
BOND OH2 H1 OH2 H2 H1 H2    ! the last bond is needed for shake
ANGLE H1 OH2 H2             ! required
DONOR H1 OH2
ACCEPTOR OH2
PATCHING FIRS NONE LAST NONE

PRES CUT         0.10 ! a patch
DELETE ATOM H2
ATOM OH2  OT     -0.734
END

read para card flex @app
* Parameters for water and ions
*

ATOMS
MASS  -1  HT         1.00800 ! TIPS3P WATER HYDROGEN
MASS  -1  OT        15.99940 ! TIPS3P WATER OXYGEN

BONDS
!V(bond) = Kb(b - b0)**2
HT    HT      0.0       1.5139  ! from TIPS3P geometry (for SHAKE w/PARAM)
OT    HT    450.0       0.9572  ! from TIPS3P geometry

ANGLES
HT   OT   HT     55.0      104.52   ! FROM TIPS3P GEOMETRY

DIHEDRALS
HT  OT  OT  HT   2.02     2     0.0

IMPROPER
HT  X  X  HT   2.02     0     0.0

NONBONDED nbxmod  5 atom cdiel fshift vatom vdistance vfswitch - ! continued
cutnb 14.0 ctofnb 12.0 ctonnb 10.0 eps 1.0 e14fac 1.0 wmin 1.5

HT       0.0       -0.046     0.2245
OT       0.0       -0.1521    1.7682   0.0 -0.01 1.9 ! of 1-4 pairs

NBFIX
!              Emin         Rmin
HT     OT      -0.05   2.0
HBOND CUTHB 0.5
END
return
)";

ForceField parsed(std::string_view text) {
    return test::force_field_of(fmt::format("{}\nEND\n", text), "a.str");
}

std::string error_of(std::string_view text) {
    return load_error_of([&] { parsed(text); });
}

void check_is_tip3p(const ForceField& force_field) {
    REQUIRE(force_field.residues.count("TIP3") == 1);
    const Residue& water = force_field.residues.at("TIP3");
    REQUIRE(water.atoms.size() == 3);
    CHECK(water.charge == 0);
    CHECK(water.atoms[0].name == "OH2");
    CHECK(water.atoms[0].type == "OT");
    CHECK(water.atoms[0].charge == -0.834);
    CHECK(water.atoms[1].name == "H1");
    CHECK(water.atoms[2].name == "H2");
    CHECK(water.atoms[2].type == "HT");
    CHECK(water.atoms[2].charge == 0.417);
    CHECK(force_field.types.at("OT").mass == 15.9994);
    CHECK(force_field.types.at("OT").element == "O");
    CHECK(force_field.types.at("HT").mass == 1.008);
    CHECK(force_field.nonbonded.at("OT").epsilon == 0.1521);
    CHECK(force_field.nonbonded.at("OT").half_rmin == 1.7682);
    CHECK(force_field.nonbonded.at("HT").epsilon == 0.046);
    CHECK(force_field.nonbonded.at("HT").half_rmin == 0.2245);
    CHECK(force_field.bonds.at({"HT", "OT"}).k == 450);
    CHECK(force_field.bonds.at({"HT", "OT"}).value == 0.9572);
    CHECK(force_field.bonds.at({"HT", "HT"}).value == 1.5139);
    CHECK(force_field.angles.at({"HT", "OT", "HT"}).k == 55);
    CHECK(force_field.angles.at({"HT", "OT", "HT"}).value == 104.52);
}

}  // namespace

TEST_CASE("a Urey-Bradley term may push, as in CHARMM's nucleic acids", "[charmm]") {
    const ForceField force_field =
        test::force_field_of("read para\nANGLES\nP ON2 P 15.0 140.0 -40.0 2.80\nEND\n", "na.str");
    REQUIRE(force_field.angles.size() == 1);
    CHECK(force_field.angles.begin()->second.urey_bradley_k == -40);
}

TEST_CASE("a stream file of TIP3P is read, topology and parameters in one",
          "[charmm][force_field]") {
    const ForceField force_field = parsed(tip3p);

    check_is_tip3p(force_field);
    // Nothing beside: no residue from the patch, no type from an option line.
    CHECK(force_field.residues.size() == 1);
    CHECK(force_field.types.size() == 2);
    CHECK(force_field.nonbonded.size() == 2);
    CHECK(force_field.bonds.size() == 2);
    CHECK(force_field.angles.size() == 1);
    REQUIRE(force_field.nbfix.size() == 1);
    const NbfixPair& pair = force_field.nbfix.at({"HT", "OT"});
    CHECK(pair.epsilon == 0.05);
    CHECK(pair.rmin == 2.0);
    CHECK(force_field.files == std::vector<std::string>{"a.str"});
}

TEST_CASE("residues and patches are read with all that they hold", "[charmm][force_field]") {
    const ForceField force_field = parsed(tip3p);

    const Residue& water = force_field.residues.at("TIP3");
    CHECK(water.bonds.size() == 3);
    CHECK(water.angles == std::vector<std::array<std::string, 3>>{{"H1", "OH2", "H2"}});
    CHECK(water.first_patch == "NONE");
    CHECK_FALSE(water.has_generated_angles);
    CHECK_FALSE(water.has_generated_dihedrals);
    CHECK(force_field.generates_angles);
    CHECK(force_field.generates_dihedrals);
    const Residue& patch = force_field.patches.at("CUT");
    CHECK(patch.charge == 0.1);
    CHECK(patch.deleted_atoms == std::vector<std::string>{"H2"});
    REQUIRE(patch.atoms.size() == 1);
    CHECK(patch.atoms[0].charge == -0.734);
    CHECK(patch.has_generated_angles);

    const ForceField peptide = parsed(
        "DEFA FIRS NTER LAST CTER\nRESI ALA 0.0\nGROUP\nATOM N NH1 -0.47\nGROUP\nATOM C C "
        "0.47\nDOUBLE N C\nIMPR N -C CA HN  C CA +N O\nDIHE A B C D\n"
        "CMAP -C N CA C N CA C +N\nIC -C CA *N HN 1.3551 126.49 180.0 115.42 0.9996\n"
        "IC -C N CA C 1.0 2.0 3.0 4.0 5.0\nPATCHING LAST XTER\nDEFA FIRST NONE\nRESI X 0.0\n"
        "LONEPAIR COLINEAR LP CL C DIST 1.6\nPRES P 0.0\nDELE IMPR A B C D\nDELE ACCE O\n");
    const Residue& alanine = peptide.residues.at("ALA");
    CHECK(alanine.atoms[0].group == 0);
    CHECK(alanine.atoms[1].group == 1);
    CHECK(alanine.bonds == std::vector<std::array<std::string, 2>>{{"N", "C"}});
    REQUIRE(alanine.impropers.size() == 2);
    CHECK(alanine.impropers[1] == std::array<std::string, 4>{"C", "CA", "+N", "O"});
    CHECK(alanine.dihedrals.size() == 1);
    REQUIRE(alanine.cmaps.size() == 1);
    CHECK(alanine.cmaps[0][7] == "+N");
    REQUIRE(alanine.internal_coordinates.size() == 2);
    const InternalCoordinate& ic = alanine.internal_coordinates[0];
    CHECK(ic.is_improper);
    CHECK(ic.atoms == std::array<std::string, 4>{"-C", "CA", "N", "HN"});
    CHECK(ic.first_bond == 1.3551);
    CHECK(ic.first_angle_deg == 126.49);
    CHECK(ic.dihedral_deg == 180);
    CHECK(ic.last_angle_deg == 115.42);
    CHECK(ic.last_bond == 0.9996);
    CHECK_FALSE(alanine.internal_coordinates[1].is_improper);
    CHECK(alanine.first_patch == "NTER");
    CHECK(alanine.last_patch == "XTER");
    CHECK(peptide.residues.at("X").first_patch == "NONE");
    CHECK(peptide.residues.at("X").last_patch == "CTER");
    CHECK(peptide.residues.at("X").lone_pair_line == 16);
    CHECK(peptide.patches.at("P").deleted_impropers.size() == 1);
}

TEST_CASE("every section of a parameter file is read", "[charmm][force_field]") {
    const ForceField force_field = parsed(
        "ANGLES\nC B A 1.0 90.0 2.0 3.0\nDIHEDRALS\nD C B A 1.0 1 180.0\nA B C D 2.0 3 0.0\n"
        "X C B X 0.5 2 180\nIMPROPER\nD X X A 4.0 0 1.0\nCMAP\n"
        "A B C D B C D A 2\n0.0 1.0\n-2.0 3.0\nNONBONDED nbxmod 5 e14fac 1.0\n"
        "A 0.0 -0.1 2.0 0.0 -0.2 1.9\nB 0.0 -0.1 2.0\nNBFIX\nB A -0.1 2.0 -0.2 1.9\n");

    const AngleParameter& angle = force_field.angles.at({"A", "B", "C"});
    CHECK(angle.urey_bradley_k == 2);
    CHECK(angle.urey_bradley_s0 == 3);
    const auto& terms = force_field.dihedrals.at({"A", "B", "C", "D"});
    REQUIRE(terms.size() == 2);
    CHECK(terms[0].phase_deg == 180);
    CHECK(terms[1].multiplicity == 3);
    CHECK(force_field.dihedrals.count({"X", "B", "C", "X"}) == 1);
    CHECK(force_field.impropers.at({"A", "X", "X", "D"})[0].k == 4);
    CHECK(force_field.cmaps.at({"A", "B", "C", "D", "B", "C", "D", "A"}).energies ==
          std::vector<double>{0, 1, -2, 3});
    CHECK(force_field.nonbonded.at("A").epsilon14 == 0.2);
    CHECK(force_field.nonbonded.at("A").half_rmin14 == 1.9);
    CHECK(force_field.nonbonded.at("B").half_rmin14 == 2.0);
    CHECK(force_field.nbfix.at({"A", "B"}).rmin14 == 1.9);
}

TEST_CASE("every entry knows the line it came from", "[charmm][force_field]") {
    const ForceField force_field = parsed(tip3p);

    // Counted in the text above.
    CHECK(to_string(force_field.types.at("HT").place) == "a.str:14");
    CHECK(to_string(force_field.residues.at("TIP3").place) == "a.str:20");
    CHECK(to_string(force_field.residues.at("TIP3").atoms[2].place) == "a.str:24");
    CHECK(to_string(force_field.bonds.at({"HT", "OT"}).place) == "a.str:47");
    CHECK(to_string(force_field.angles.at({"HT", "OT", "HT"}).place) == "a.str:50");
    CHECK(to_string(force_field.nonbonded.at("OT").place) == "a.str:62");
    CHECK(to_string(force_field.nbfix.at({"HT", "OT"}).place) == "a.str:66");
}

TEST_CASE("CHARMM's own file of water and ions gives TIP3P's published numbers",
          "[charmm][force_field]") {
    const auto file = test::find_shared_data("data/charmm/toppar_water_ions.str");
    if (!file) return;

    const ForceField force_field = read_force_field(std::array{*file});

    check_is_tip3p(force_field);
    CHECK(force_field.residues.at("SOD").charge == 1);
    CHECK(force_field.nonbonded.at("CLA").half_rmin == 2.27);
    // The file ends with NBFIX lines for sodium, in a second parameter part.
    CHECK_FALSE(force_field.nbfix.empty());
}

TEST_CASE("the scene's own TIP3P file says the same as CHARMM's", "[charmm][force_field]") {
    const std::filesystem::path file = test::in_project("scenes/water/tip3p.str");

    const ForceField force_field = read_force_field(std::array{file});

    REQUIRE(force_field.residues.at("TIP3").atoms.size() == 3);
    CHECK(force_field.residues.at("TIP3").atoms[0].charge == -0.834);
    CHECK(force_field.nonbonded.at("OT").epsilon == 0.1521);
    CHECK(force_field.nonbonded.at("HT").half_rmin == 0.2245);
}

TEST_CASE("case counts nowhere", "[charmm][force_field]") {
    std::string lower(tip3p);
    for (char& letter : lower) {
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    }

    check_is_tip3p(parsed(lower));
}

TEST_CASE("carriage returns and tabs are blanks", "[charmm][force_field]") {
    std::string text;
    for (const char letter : tip3p) {
        if (letter == '\n') text += '\r';
        text += letter == ' ' ? '\t' : letter;
    }

    check_is_tip3p(parsed(text));
}

TEST_CASE("a '-' at the end continues a line, behind it only a comment", "[charmm][force_field]") {
    const ForceField force_field = parsed(
        "read para\nBONDS\nHT - ! first\n  OT -\n450.0 0.9572\n"
        "OT OT 1.0 -1.5\n");

    REQUIRE(force_field.bonds.size() == 2);
    CHECK(force_field.bonds.at({"HT", "OT"}).value == 0.9572);
    CHECK(to_string(force_field.bonds.at({"HT", "OT"}).place) == "a.str:3");
    // A minus sign before a number is none of that.
    CHECK(force_field.bonds.at({"OT", "OT"}).value == -1.5);
}

TEST_CASE("a lone '-' hides nothing of what follows", "[charmm][force_field]") {
    const ForceField after_blank = parsed("-\n\nMASS -1 OT 15.9994 O\n");
    const ForceField after_comment = parsed("-\n! comment\nMASS -1 OT 15.9994 O\n");

    CHECK(after_blank.types.count("OT") == 1);
    CHECK(after_comment.types.count("OT") == 1);
    CHECK_THAT(error_of("- \n - ! more\n\nNONSENSE\n"), StartsWith("a.str:4: "));
    CHECK(error_of("-") == "no error");
}

TEST_CASE("topology and parameters may come as plain files without read lines",
          "[charmm][force_field]") {
    ForceField force_field;
    parse_force_field("* title\n36 1\nMASS 1 OT 15.9994 O\nRESI X 0.0\nATOM O OT 0.0\nEND\n",
                      "a.rtf", force_field);
    parse_force_field("* title\nBONDS\nOT OT 1.0 1.2\nNONBONDED\nOT 0.0 -0.1 1.7\nEND\n", "a.prm",
                      force_field);

    CHECK(force_field.residues.at("X").atoms.size() == 1);
    CHECK(force_field.bonds.size() == 1);
    CHECK(force_field.nonbonded.at("OT").epsilon == 0.1);
    CHECK(force_field.files == std::vector<std::string>{"a.rtf", "a.prm"});
    CHECK(to_string(force_field.bonds.begin()->second.place) == "a.prm:3");
}

TEST_CASE("an empty text adds nothing but its name", "[charmm][force_field]") {
    const ForceField force_field = parsed(GENERATE("", "\n", "* title\n*\n", "! comment"));

    CHECK(force_field.types.empty());
    CHECK(force_field.residues.empty());
    CHECK(force_field.files.size() == 1);
}

TEST_CASE("several files are read in order, and errors name theirs", "[charmm][force_field]") {
    const test::TemporaryFolder folder;
    const auto first = folder.add_file("first.rtf", "MASS -1 OT 15.9994 O\n");
    const auto second = folder.add_file("second.rtf", "MASS -1 HT 1.008 H\nMASS -1 OT 15.9994\n");
    const auto third = folder.add_file("third.rtf", "\nMASS -1 OT 17.0\n");

    const ForceField force_field = read_force_field(std::array{first, second});

    CHECK(force_field.types.size() == 2);
    CHECK(force_field.types.at("OT").element == "O");
    CHECK(force_field.files == std::vector<std::string>{first.string(), second.string()});
    const ForceField replaced = read_force_field(std::array{first, second, third});
    CHECK(replaced.types.at("OT").mass == 17);
    REQUIRE(replaced.notes.size() == 1);
    CHECK(describe_note(replaced.notes[0]) ==
          third.string() + ":2: mass of OT replaces that of " + first.string() + ":1");
    CHECK(load_error_of([&] { read_force_field(std::array{folder.path() / "none.prm"}); }) ==
          (folder.path() / "none.prm").string() + ": no such file");
    CHECK(load_error_of([&] {
              read_force_field(std::array{first, second, folder.path() / "." / "first.rtf"});
          }) ==
          (folder.path() / "." / "first.rtf").string() + ": given twice; expected each file once");
}

TEST_CASE("a value that does not parse is told with its line", "[charmm][force_field]") {
    struct Row {
        const char* text;
        const char* line;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {"\nMASS -1 OT 15.9.94 O\n", "2", "'15.9.94' is not a number; expected the mass"},
        {"MASS x OT 15.9994 O\n", "1", "'X' is not a number"},
        {"MASS -1 OT nan O\n", "1", "'NAN' is not a number"},
        {"MASS -1 OT -1.0 O\n", "1", "expected 0 or more"},
        {"MASS -1\n", "1", "the type is missing; expected: MASS number type mass [element]"},
        {"MASS -1 OT\n", "1", "the mass is missing"},
        {"RESI\n", "1", "the name is missing; expected: RESI name charge [NOANG]"},
        {"RESI TIP3\n", "1", "the charge is missing"},
        {"RESI TIP3 neutral\n", "1", "'NEUTRAL' is not a number"},
        {"RESI TIP3 0.0\nATOM OH2 OT\n", "2", "the charge is missing"},
        {"RESI TIP3 0.0\nATOM OH2\n", "2", "the type is missing; expected: ATOM name type charge"},
        {"RESI TIP3 0.0\n\nATOM OH2 OT inf\n", "3", "'INF' is not a number; expected the charge"},
        {"BONDS\nHT OT 450.0\n", "2", "the r0 is missing; expected: type1 type2 k r0"},
        {"BONDS\nHT\n", "2", "the type2 is missing"},
        {"BONDS\nHT OT 450.0 long\n", "2", "'LONG' is not a number"},
        {"ANGLES\nHT OT HT 55.0\n", "2", "the angle is missing"},
        {"ANGLES\nHT OT\n", "2",
         "the type3 is missing; expected: type1 type2 type3 k angle [k_UB S0]"},
        {"NONBONDED\nOT 0.0 -0.1\n", "2", "the Rmin/2 is missing"},
        {"NONBONDED\nOT 0.0 -0.1 -\n1e999\n", "2", "'1E999' is not a number"},
        {"NONBONDED\nOT 0.0 0.1521 1.7682\n", "2", "expected -epsilon (0 or less)"},
        {"NONBONDED\nOT 0.0 -0.1521 -1.7682\n", "2", "Rmin/2 of 0 or more"},
        {"NBFIX\nHT\n", "2", "the type2 is missing"},
        {"MASS -1 OT 15.9994 OX\n", "1", "unknown element 'OX'"},
        {"RESI A 0.0 NOBOND\n", "1", "'NOBOND' is not an option of a residue"},
        {"RESI A 0.0\nATOM O OT 0.1 0.2\n", "2", "extra word '0.2'"},
        {"RESI A 0.0\nATOM O OT 0.1 ALPHA -0.2 THOLE 1.3\n", "2", "extra word 'ALPHA'"},
        {"RESI A 0.0\nIMPR A B C\n", "2", "a IMPR line has 3 names; expected a multiple of 4"},
        {"RESI A 0.0\nIC A B C D 1.0 2.0\n", "2", "the dihedral is missing; expected: IC a b c d"},
        {"RESI A 0.0\nPATCH MIDDLE X\n", "2", "'MIDDLE' is not an end of a chain"},
        {"RESI A 0.0\nDELETE GROUP A B\n", "2", "'GROUP' cannot be deleted"},
        {"RESI A 0.0\nDELETE ANGLE A B\n", "2",
         "a DELETE line has 2 names; expected a multiple of 3"},
        {"AUTO BONDS\n", "1", "'BONDS' cannot be generated"},
        {"ANGLES\nA B C 1.0 90.0 2.0\n", "2", "the S0 is missing"},
        {"BONDS\nA B 1.0 1.5 2.0\n", "2", "extra word '2.0'"},
        {"DIHEDRALS\nA B C D 1.0 1.5 0.0\n", "2", "'1.5' is not a whole number"},
        {"DIHEDRALS\nA B C D 1.0 -1 0.0\n", "2", "the multiplicity is -1; expected 0 to 12"},
        {"IMPROPER\nA B C D 1.0 13 0.0\n", "2", "the multiplicity is 13; expected 0 to 12"},
        {"DIHEDRALS\nA X C D 1.0 1 0.0\n", "2", "expected X B C X"},
        {"IMPROPER\nA X C D 1.0 1 0.0\n", "2", "A X X D, X B C D"},
        {"DIHEDRALS\nA B C D 1.0 1 0.0\nA B C D 1.0 0 0.0\n", "3", "first in a.str:2"},
        {"CMAP\nA B C D A B C D 2\n1 2\n1 2 3\n", "4", "more than the 4 numbers"},
        {"CMAP\nA B C D A B C D 2\n1 2\n\nNONBONDED\n", "2", "2 numbers; expected 4"},
        {"CMAP\nA B C D A B C D 2\n1 2\n", "2", "2 numbers; expected 4"},
        {"CMAP\nA B C D A B C D 99999999\n1 2\n", "2", "expected 2 to 360"},
        {"CMAP\nA B C D A B C D 2\n1 x\n", "3",
         "'X' is not a number; expected energy 2 of 4 of the map of a.str:2"},
        {"CMAP\nA B C D A B C D 2\n1 2\nO.5 2\n", "4", "'O.5' is not a number; expected energy 3"},
        {"NONBONDED\nOT 0.0 -0.1 1.7 0.0 0.1 1.7\n", "2", "expected -epsilon (0 or less)"},
        {"NONBONDED nbxmod 5 e14fac 0.5\n", "1", "E14FAC 0.5 is not supported"},
        {"NONBONDED geometric\n", "1", "'GEOMETRIC' is not supported"},
        {"NBFIX\nHT OT 0.1 2.0\n", "2", "expected -epsilon (0 or less)"},
        {"NBFIX\nHT OT -0.1 -2.0\n", "2", "Rmin of 0 or more"},
    }));
    INFO(row.text);

    CHECK_THAT(error_of(row.text),
               StartsWith(std::string("a.str:") + row.line + ": ") && Contains(row.what));
}

TEST_CASE("a line that nobody knows is told, in topology, parameters and script",
          "[charmm][force_field]") {
    CHECK_THAT(error_of("MASS -1 OT 15.9994\nRESIDUUM X 0.0\nCHARGE OT 1.0\n"),
               StartsWith("a.str:3: 'CHARGE' is not a line of a topology file"));
    CHECK_THAT(error_of("read para\n\nCHARGES\n"),
               StartsWith("a.str:3: 'CHARGES' is not a section of a parameter file"));
    CHECK_THAT(error_of("read para\nATOMS\nOT HT 450.0 1.0\n"), StartsWith("a.str:3: "));
    CHECK_THAT(error_of("\nread psf card\n"),
               StartsWith("a.str:2: 'READ PSF CARD' cannot be read"));
    CHECK_THAT(error_of("read\n"), StartsWith("a.str:1: 'READ' cannot be read"));
}

TEST_CASE("a misspelt line or section has a hint", "[charmm][force_field]") {
    CHECK_THAT(error_of("BONDS\nA B 1.0 1.0\nANGELS\n"),
               StartsWith("a.str:3: 'ANGELS' is not a section of a parameter file") &&
                   Contains("did you mean 'ANGLES'?"));
    CHECK_THAT(error_of("CMAP\nA B C D A B C D 2\n1 2\n3 4\nNOBFIX\n"),
               StartsWith("a.str:5: ") && Contains("did you mean 'NBFIX'?"));
    CHECK_THAT(error_of("RESI A 0.0\nATM A T 0.0\n"),
               StartsWith("a.str:2: ") && Contains("did you mean 'ATOM'?"));
    CHECK_THAT(error_of("ANGELS\nA B C 1.0 90.0\n"), Contains("did you mean 'ANGLES'?"));
}

TEST_CASE("a file that ends inside a residue or a section is told as cut",
          "[charmm][force_field]") {
    const auto error = [](std::string_view text) {
        return load_error_of([&] { test::force_field_of(text, "a.str"); });
    };

    CHECK(error("MASS -1 OT 16.0\nRESI A 0.0\nATOM O OT 0.0\n") ==
          "a.str:3: the file ends inside the residue of line 2, so it may be cut off; expected END "
          "after it");
    CHECK_THAT(error("PRES A 0.0\nEND\nRESI B 0.0"), StartsWith("a.str:3: the file ends inside"));
    CHECK(error("BONDS\nA B 1.0 1.0\nreturn\n") != "no error");
    CHECK(error("BONDS\nA B 1.0 1.0\n") ==
          "a.str:2: the file ends inside a section of parameters, so it may be cut off; expected "
          "END after it");
    CHECK_THAT(error("CMAP\nA B C D A B C D 2\n1 2\n"), Contains("2 numbers; expected 4"));
    CHECK(error("MASS -1 OT 16.0\n") == "no error");
    CHECK(error("read rtf\nRESI A 0.0\nEND\nreturn\n") == "no error");
}

TEST_CASE("a structure given as a force field file is told", "[charmm][force_field]") {
    struct Row {
        const char* text;
        const char* message;
    };
    const auto row = GENERATE(values<Row>({
        {"HEADER  PLANT PROTEIN\n",
         "a.str:1: this looks like coordinates (a PDB file); expected a "},
        {"ATOM      1  N   THR A   1      17.047  14.099   3.625  1.00 13.79\n",
         "a.str:1: this looks like coordinates (a PDB file)"},
        {"* CRAMBIN\n  642\n 1 1 THR N 17.0 14.0 3.6 PROA 1 0.0\n",
         "a.str:3: this looks like coordinates (a CRD file)"},
        {"* CRAMBIN\n*\n  642  EXT\n", "a.str:3: this looks like coordinates (a CRD file)"},
        {"data_1CRN\nloop_\n", "a.str:1: this looks like coordinates (an mmCIF file)"},
        {"PSF EXT CMAP\n", "a.str:1: this looks like a PSF"},
    }));
    INFO(row.text);

    CHECK_THAT(error_of(row.text), StartsWith(row.message));
}

TEST_CASE("an atom line needs a residue before it", "[charmm][force_field]") {
    CHECK_THAT(error_of("read rtf\nATOM OH2 OT 0.0\n"),
               StartsWith("a.str:2: an ATOM line outside"));
    CHECK_THAT(error_of("RESI A 0.0\nEND\nread rtf\nATOM OH2 OT 0.0\n"),
               StartsWith("a.str:4: an ATOM line outside"));
    CHECK_THAT(error_of("ATOM OH2 OT 0.0\n"), StartsWith("a.str:1: an ATOM line outside"));
}

TEST_CASE("an atom stands once in a residue", "[charmm][force_field]") {
    CHECK(error_of("RESI A 0.0\nATOM O OT 0.1\nATOM O OT 0.1\n") ==
          "a.str:3: atom 'O' is repeated, first in a.str:2");
}

TEST_CASE("what is given again replaces the earlier and is noted with both places",
          "[charmm][force_field]") {
    struct Row {
        const char* text;
        const char* note;
    };
    const auto row = GENERATE(values<Row>({
        {"MASS 1 OT 15.9994\nMASS 2 OT 16.5\n", "mass of OT replaces that of a.str:1"},
        {"RESI A 0.0\nRESI A 1.0\n", "residue A replaces that of a.str:1"},
        {"PRES A 0.0\nPRES A 0.0\n", "patch A replaces that of a.str:1"},
        {"BONDS\nHT OT 450.0 1.0\nOT HT 450.0 1.1\n", "bond HT OT replaces that of a.str:2"},
        {"BONDS\nHT OT 450.0 1.0\nOT HT 451.0 1.0\n", "bond HT OT replaces"},
        {"ANGLES\nHT OT CT 55.0 100.0\nCT OT HT 55.0 101.0\n", "angle CT OT HT replaces"},
        {"DIHEDRALS\nA B C D 1.0 1 0.0\nD C B A 2.0 1 0.0\n", "dihedral A B C D 1 replaces"},
        {"IMPROPER\nA X X D 1.0 0 0.0\nD X X A 2.0 0 0.0\n", "improper A X X D 0 replaces"},
        {"CMAP\nA B C D A B C D 2\n1 2 3 4\nA B C D A B C D 2\n1 2 3 5\n",
         "CMAP A B C D A B C D replaces"},
        {"NONBONDED\nOT 0.0 -0.1 1.7\nOT 0.0 -0.1 1.7 0.0 -0.1 1.6\n",
         "non-bonded type OT replaces"},
        {"NONBONDED\nOT 0.0 -0.1 1.7\nOT 0.0 -0.1 1.8\n", "non-bonded type OT replaces"},
        {"NBFIX\nHT OT -0.1 2.0\nOT HT -0.2 2.0\n", "NBFIX OT HT replaces that of a.str:2"},
    }));
    INFO(row.text);

    const ForceField force_field = parsed(row.text);

    REQUIRE(force_field.notes.size() == 1);
    CHECK(force_field.notes[0].kind == ForceFieldNote::Kind::Replaced);
    CHECK_THAT(describe_note(force_field.notes[0]), StartsWith("a.str:") && Contains(row.note));
}

TEST_CASE("of what is given again the later counts, whole", "[charmm][force_field]") {
    const ForceField force_field = parsed(
        "MASS 1 OT 15.9994\nMASS 2 OT 16.5\nRESI A 0.0\nATOM O OT 0.1\nBOND O O2\nRESI A 1.0\n"
        "ATOM P OT 1.0\nEND\nBONDS\nHT OT 450.0 1.0\nOT HT 451.0 1.1\nNBFIX\nHT OT -0.1 2.0\n"
        "OT HT -0.2 2.1\nCMAP\nA B C D A B C D 2\n1 2 3 4\nA B C D A B C D 2\n1 2 3 5\n");

    CHECK(force_field.types.at("OT").mass == 16.5);
    CHECK(force_field.residues.at("A").charge == 1);
    REQUIRE(force_field.residues.at("A").atoms.size() == 1);
    CHECK(force_field.residues.at("A").atoms[0].name == "P");
    CHECK(force_field.residues.at("A").bonds.empty());
    CHECK(force_field.bonds.at({"HT", "OT"}).k == 451);
    CHECK(force_field.bonds.at({"HT", "OT"}).value == 1.1);
    CHECK(force_field.nbfix.at({"HT", "OT"}).rmin == 2.1);
    CHECK(force_field.cmaps.begin()->second.energies[3] == 5);
}

TEST_CASE("a dihedral given again in a later part loses its earlier multiplicities",
          "[charmm][force_field]") {
    ForceField force_field = parsed("DIHEDRALS\nA B C D 1.0 1 0.0\nA B C D 1.0 2 0.0\n");
    const std::vector<DihedralTerm>& terms = force_field.dihedrals.begin()->second;

    SECTION("by the same terms in another order, which is not noted") {
        parse_force_field("DIHEDRALS\nD C B A 1.0 2 0.0\nD C B A 1.0 1 0.0\nEND\n", "b.prm",
                          force_field);
        CHECK(terms.size() == 2);
        CHECK(force_field.notes.empty());
    }
    SECTION("by some of them") {
        parse_force_field("DIHEDRALS\nA B C D 1.0 2 0.0\nEND\n", "b.prm", force_field);
        REQUIRE(terms.size() == 1);
        CHECK(terms[0].multiplicity == 2);
        REQUIRE(force_field.notes.size() == 1);
        CHECK(describe_note(force_field.notes[0]) ==
              "b.prm:2: dihedral A B C D replaces that of a.str:2");
    }
    SECTION("by others, also where its own file has them in a second part") {
        parse_force_field(
            "read para\nDIHEDRALS\nA B C D 3.0 6 0.0\nEND\nread para\nDIHEDRALS\n"
            "A B C D 1.0 3 180.0\nA B C D 2.0 8 0.0\nEND\n",
            "b.prm", force_field);
        REQUIRE(terms.size() == 2);
        CHECK(terms[0].multiplicity == 3);
        CHECK(terms[1].multiplicity == 8);
        CHECK(force_field.notes.size() == 2);
    }
    SECTION("by a harmonic one") {
        parse_force_field("DIHEDRALS\nA B C D 3.0 0 0.0\nEND\n", "b.prm", force_field);
        REQUIRE(terms.size() == 1);
        CHECK(terms[0].multiplicity == 0);
    }
}

TEST_CASE("force constants below 0 are taken and noted", "[charmm][force_field]") {
    const ForceField force_field =
        parsed("BONDS\nHT OT -450.0 1.0\nANGLES\nP ON2 P 15.0 140.0 -40.0 2.80\nA B C -2.0 90.0\n");

    CHECK(force_field.bonds.at({"HT", "OT"}).k == -450);
    CHECK(force_field.angles.at({"P", "ON2", "P"}).urey_bradley_k == -40);
    REQUIRE(force_field.notes.size() == 3);
    CHECK(describe_note(force_field.notes[0]) == "a.str:2: a force constant of -450 of bond HT OT");
    CHECK(describe_note(force_field.notes[1]) ==
          "a.str:4: a force constant of -40 of Urey-Bradley angle P ON2 P");
    CHECK(describe_notes(force_field.notes).size() == 1);
    CHECK_THAT(describe_notes(force_field.notes)[0],
               StartsWith("3 negative force constants, used as they are: a.str:2: "));
}

TEST_CASE("words behind an ATOM line's charge are passed over and noted", "[charmm][force_field]") {
    const ForceField force_field = parsed("RESI A 0.0\nATOM H53 HB2 0.06   C\n");

    CHECK(force_field.residues.at("A").atoms[0].charge == 0.06);
    REQUIRE(force_field.notes.size() == 1);
    CHECK(describe_note(force_field.notes[0]) ==
          "a.str:2: extra word 'C' at the end of an ATOM line is ignored");
}

TEST_CASE("of many notes the first three are listed and all are counted", "[charmm][force_field]") {
    std::string text = "BONDS\n";
    for (const char* const k : {"1.0", "2.0", "3.0", "4.0", "5.0"}) {
        text += fmt::format("A B {} 1.5\n", k);
    }

    const std::vector<std::string> told = describe_notes(parsed(text).notes);

    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0],
               StartsWith("4 entries of the force field defined again; the last definition is "
                          "used: a.str:3: bond A B replaces that of a.str:2; a.str:4: ") &&
                   Contains("a.str:5: ") && Catch::EndsWith("; ...") && !Contains("a.str:6: bond"));
    CHECK(describe_notes({}).empty());
}

TEST_CASE("patches take bonds, angles and dihedrals away", "[charmm][force_field]") {
    const ForceField force_field = parsed(
        "PRES P 0.0\nDELETE ATOM H1 H2\nDELETE BOND O2' H2'\nDELE ANGL 1A 1B 1C 1D 1E 1F\n"
        "DELETE DIHE A B C D\nDELETE IMPR A B C D\nDELETE CMAP A B C D E F G H\n"
        "DELETE ACCEPTOR O\n");
    const Residue& patch = force_field.patches.at("P");

    CHECK(patch.deleted_atoms == std::vector<std::string>{"H1", "H2"});
    REQUIRE(patch.deleted_bonds.size() == 1);
    CHECK(patch.deleted_bonds[0] == std::array<std::string, 2>{"O2'", "H2'"});
    REQUIRE(patch.deleted_angles.size() == 2);
    CHECK(patch.deleted_angles[1] == std::array<std::string, 3>{"1D", "1E", "1F"});
    CHECK(patch.deleted_dihedrals.size() == 1);
    CHECK(patch.deleted_impropers.size() == 1);
    CHECK(patch.deleted_cmaps.size() == 1);
}

TEST_CASE("the same once more is no mistake, in either order of its types",
          "[charmm][force_field]") {
    const ForceField force_field = parsed(
        "read para\nATOMS\nMASS 1 OT 15.9994 O\nMASS 2 OT 15.9990\n"
        "BONDS\nHT OT 450.0 1.0\nOT HT 450.0 1.0\n"
        "ANGLES\nHT OT CT 55.0 100.0\nCT OT HT 55.0 100.0\n"
        "NONBONDED\nOT 0.0 -0.1 1.7\nOT 0.0 -0.1 1.7\n");

    CHECK(force_field.types.at("OT").mass == 15.9994);
    CHECK(force_field.bonds.size() == 1);
    CHECK(force_field.angles.size() == 1);
    CHECK(to_string(force_field.nonbonded.at("OT").place) == "a.str:12");
}
