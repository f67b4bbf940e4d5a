#include "charmm/assign.h"

#include "formats/crd.h"
#include "tests/support/force_field_of.h"
#include "tests/support/load_error_of.h"
#include "tests/support/structure_of.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;
using test::load_error_of;

namespace {

constexpr std::string_view water_and_ions = R"(read rtf
MASS -1 HT 1.00800 H
MASS -1 OT 15.99940 O
MASS -1 SOD 22.98977 NA
MASS -1 CLA 35.45000 CL
RESI TIP3 0.000
ATOM OH2 OT -0.834
ATOM H1 HT 0.417
ATOM H2 HT 0.417
RESI SOD 1.00
ATOM SOD SOD 1.00
RESI CLA -1.00
ATOM CLA CLA -1.00
END
read para
NONBONDED
HT 0.0 -0.046 0.2245
OT 0.0 -0.1521 1.7682
SOD 0.0 -0.0469 1.41075
CLA 0.0 -0.150 2.27
)";

ForceField small_force_field(const std::string& text) {
    return test::force_field_of(text + "END\n", "a.str");
}

ForceField water_with(const std::string& more = "") {
    return small_force_field(std::string(water_and_ions) + more + "END\n");
}

// Behind the three lines that CHARMM's coordinates begin with.
Structure small_structure(const std::vector<AtomName>& names) {
    return test::structure_of(names, "s.crd", 4);
}

const std::vector<AtomName> two_waters{{"A", "TIP3", "1", "OH2"}, {"A", "TIP3", "1", "H1"},
                                       {"A", "TIP3", "1", "H2"},  {"B", "TIP3", "1", "H2"},
                                       {"B", "TIP3", "1", "OH2"}, {"B", "TIP3", "1", "H1"}};

std::string error_of(const ForceField& force_field, const std::vector<AtomName>& names,
                     const std::string& segment) {
    AtomTable table;
    const std::string error = load_error_of(
        [&] { add_segment_atoms(force_field, small_structure(names), segment, table); });
    // A failure adds nothing.
    if (error != "no error") CHECK(table.size() == 0);
    return error;
}

}  // namespace

TEST_CASE("atoms get their numbers by name, in the order of the structure", "[charmm][assign]") {
    AtomTable table;

    const AtomRange b = add_segment_atoms(water_with(), small_structure(two_waters), "B", table);
    const AtomRange a = add_segment_atoms(water_with(), small_structure(two_waters), "A", table);

    CHECK(b.first == 0);
    CHECK(b.count == 3);
    CHECK(a.first == 3);
    CHECK(a.count == 3);
    REQUIRE(table.size() == 6);
    const std::vector<std::string> atoms{"H2", "OH2", "H1", "OH2", "H1", "H2"};
    const std::vector<double> x{3, 4, 5, 0, 1, 2};
    for (std::size_t i = 0; i < 6; ++i) {
        const bool oxygen = atoms[i] == "OH2";
        INFO(i);
        CHECK(table.names[i].atom == atoms[i]);
        CHECK(table.names[i].segment == (i < 3 ? "B" : "A"));
        CHECK(table.positions[i] == Vec3(x[i], 0, 0));
        CHECK(table.mass[i] == (oxygen ? 15.9994 : 1.008));
        CHECK(table.charge[i] == (oxygen ? -0.834 : 0.417));
        // sqrt(0.1521) = 0.39 exactly, sqrt(0.046) by hand.
        CHECK(table.sqrt_epsilon[i] == Approx(oxygen ? 0.39 : 0.214476106).epsilon(1e-9));
        CHECK(table.half_rmin[i] == (oxygen ? 1.7682 : 0.2245));
    }
    CHECK(table.charge[3] + table.charge[4] + table.charge[5] == Approx(0).margin(1e-15));
}

TEST_CASE("a segment that is not there is told with those that are", "[charmm][assign]") {
    CHECK(error_of(water_with(), two_waters, "C") == "s.crd: no segment 'C' (only A, B)");
}

TEST_CASE("an unknown residue is told with its near name", "[charmm][assign]") {
    const std::string error = error_of(water_with(), {{"A", "TIP4", "1", "OH2"}}, "A");

    CHECK_THAT(error, StartsWith("s.crd:4: no residue 'TIP4' in a.str") && Contains("'TIP3'?"));
    // Nothing is near to this one.
    CHECK_THAT(error_of(water_with(), {{"A", "HEXANE", "1", "C1"}}, "A"),
               !Contains("did you mean"));
}

TEST_CASE("an unknown atom is told with those that its residue has", "[charmm][assign]") {
    std::vector<AtomName> names = two_waters;
    names[1].atom = "HW1";

    CHECK_THAT(
        error_of(water_with(), names, "A"),
        StartsWith("s.crd:5: residue 'TIP3' of a.str:6 has no atom 'HW1' (only OH2, H1, H2)") &&
            Contains("lacks atom 'H1'"));
    // The other segment is whole.
    CHECK(error_of(water_with(), names, "B") == "no error");
}

TEST_CASE("a residue that is there only in part is told", "[charmm][assign]") {
    const std::vector<AtomName> names{{"A", "TIP3", "1", "OH2"},
                                      {"A", "TIP3", "1", "H1"},
                                      {"A", "TIP3", "1", "H2"},
                                      {"A", "TIP3", "2", "OH2"},
                                      {"A", "TIP3", "2", "H2"}};

    CHECK(error_of(water_with(), names, "A") == "s.crd:7: residue A TIP3 2 lacks atom 'H1'");
}

TEST_CASE("all that is missing is told at once, each thing once", "[charmm][assign]") {
    const ForceField force_field = small_force_field(
        "MASS -1 CG331 12.011 C\nMASS -1 HG 1.008 H\nRESI LIG 0.0\nATOM C1 CG332 0.0\nATOM C2 "
        "CG332 0.0\n"
        "ATOM H1 HG 0.0\nEND\nread para\nNONBONDED\nCG331 0.0 -0.1 2.0\nCG332 0.0 -0.1 2.0\n");
    const std::string error = error_of(force_field,
                                       {{"A", "LIG", "1", "C1"},
                                        {"A", "LIG", "1", "C2"},
                                        {"A", "LIG", "1", "H1"},
                                        {"A", "UNK", "2", "X"}},
                                       "A");

    CHECK_THAT(error, StartsWith("a.str:4: unknown atom type 'CG332'") && Contains("'CG331'?"));
    CHECK_THAT(error, Contains("; a.str:6: atom type 'HG' has no NONBONDED parameters"));
    CHECK_THAT(error, Contains("; s.crd:7: no residue 'UNK'"));
    const std::size_t once = error.find("unknown atom type 'CG332'");
    CHECK(error.find("unknown atom type 'CG332'", once + 1) == std::string::npos);
}

TEST_CASE("each type is named once in the table, and its atoms point to it", "[charmm][assign]") {
    AtomTable table;
    add_segment_atoms(water_with(), small_structure(two_waters), "B", table);
    add_segment_atoms(water_with(), small_structure(two_waters), "A", table);

    CHECK(table.type_names == std::vector<std::string>{"HT", "OT"});
    CHECK(table.type == std::vector<std::uint32_t>{0, 1, 0, 1, 0, 0});
}

TEST_CASE("with a connectivity, numbers and order are its own and places are found by name",
          "[charmm][assign]") {
    const ForceField force_field = water_with();
    Connectivity connectivity;
    connectivity.file = "t.psf";
    connectivity.names = {{"B", "TIP3", "1", "OH2"},
                          {"A", "TIP3", "1", "H2"},
                          {"A", "TIP3", "1", "OH2"},
                          {"A", "TIP3", "1", "H1"}};
    connectivity.type = {"OT", "HT", "OT", "HT"};
    connectivity.charge = {-0.8, 0.4, -0.9, 0.5};
    connectivity.mass = {16, 2, 17, 3};
    connectivity.lines = {5, 6, 7, 8};
    connectivity.bonds = {{2, 1}, {2, 3}, {0, 3}};
    AtomTable table;

    SECTION("as they are") {
        const AtomRange range =
            add_segment_atoms(force_field, connectivity, small_structure(two_waters), "A", table);

        CHECK(range.count == 3);
        CHECK(table.charge == std::vector<double>{0.4, -0.9, 0.5});
        CHECK(table.mass == std::vector<double>{2, 17, 3});
        CHECK(table.positions == std::vector<Vec3>{{2, 0, 0}, {0, 0, 0}, {1, 0, 0}});
        CHECK(table.half_rmin == std::vector<double>{0.2245, 1.7682, 0.2245});
        // The bond to the other segment is left out.
        CHECK(table.bonds == std::vector<std::array<std::uint32_t, 2>>{{1, 0}, {1, 2}});
    }
    SECTION("types by the numbers of MASS lines") {
        ForceField numbered = force_field;
        numbered.types.at("HT").number = 4;
        numbered.types.at("OT").number = 75;
        connectivity.type = {"75", "4", "75", "4"};
        add_segment_atoms(numbered, connectivity, small_structure(two_waters), "A", table);

        CHECK(table.type_names == std::vector<std::string>{"HT", "OT"});
    }
    SECTION("all that is missing on either side is told at once") {
        connectivity.type[1] = "HX";
        connectivity.names[3].number = "2";

        CHECK(load_error_of([&] {
                  add_segment_atoms(force_field, connectivity, small_structure(two_waters), "A",
                                    table);
              }) ==
              "t.psf:6: unknown atom type 'HX': no MASS line; did you mean 'HT'?; t.psf:6: atom "
              "type 'HX' has no NONBONDED parameters in a.str; t.psf:8: atom A TIP3 2 H1 has no "
              "coordinates in s.crd; s.crd:5: atom A TIP3 1 H1 is not in t.psf");
        CHECK(table.size() == 0);
        CHECK_THAT(load_error_of([&] {
                       add_segment_atoms(force_field, connectivity, small_structure(two_waters),
                                         "X", table);
                   }),
                   Contains("t.psf: no segment 'X' (only A, B)"));
    }
}

TEST_CASE("a residue whose atoms do not add up to its charge is told", "[charmm][assign]") {
    std::string text(water_and_ions);
    text.replace(text.find("ATOM H2 HT 0.417"), 16, "ATOM H2 HT 0.451");

    CHECK(error_of(small_force_field(text + "END\n"), two_waters, "A") ==
          "a.str:6: residue 'TIP3' is declared with 0 e, but the charges of its atoms add up to "
          "0.0340 e");
}
