#include "formats/crd.h"

#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/replaced.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;
using test::load_error_of;
using test::replaced;

namespace {

// Typed by hand after CHARMM's io.doc, (I5,I5,1X,A4,1X,A4,3F10.5,1X,A4,1X,A4,F10.5).
const std::string normal =
    "* A WATER, AND A CARBON OF A RESIDUE WITH AN INSERTION CODE\n"
    "*\n"
    "    4\n"
    "    1    1 TIP3 OH2    1.00000  -2.50000   0.00001 WATA 1      0.00000\n"
    "    2    1 TIP3 H1     1.95720  -2.50000   0.00000 WATA 1      0.00000\n"
    "    3    1 TIP3 H2     0.76000  -1.57337   0.00000 WATA 1      0.00000\n"
    "    4    2 ALA  CA  -999.99999-999.99999-999.99999 PROA 27A    1.00000\n";

// (2I10,2X,A8,2X,A8,3F20.10,2X,A8,2X,A8,F20.10)
const std::string extended_crd =
    "* TITLE\n"
    "*\n"
    "         2  EXT\n"
    "         1         1  TIP3      OH2             1.0000000001       -2.5000000000        "
    "0.0000000000  WATERSEG  1               0.0000000000\n"
    "         2         1  TIP3      H1              1.9572000000       -2.5000000000        "
    "0.0000000000  WATERSEG  1               0.0000000000\n";

std::string error_of(const std::string& text) {
    return load_error_of([&] { parse_crd(text, "w.crd"); });
}

}  // namespace

TEST_CASE("the normal form is read by its columns", "[formats][crd]") {
    const Structure structure = parse_crd(normal, "w.crd");

    REQUIRE(structure.names.size() == 4);
    REQUIRE(structure.positions.size() == 4);
    CHECK(structure.file == "w.crd");
    CHECK(to_string(structure.names[0]) == "WATA TIP3 1 OH2");
    CHECK(to_string(structure.names[2]) == "WATA TIP3 1 H2");
    CHECK(structure.names[3].segment == "PROA");
    CHECK(structure.names[3].residue == "ALA");
    CHECK(structure.names[3].number == "27A");
    CHECK(structure.names[3].atom == "CA");
    CHECK(structure.positions[0] == Vec3(1, -2.5, 0.00001));
    // Full columns touch each other.
    CHECK(structure.positions[3] == Vec3(-999.99999, -999.99999, -999.99999));
    CHECK(structure.lines == std::vector<std::size_t>{4, 5, 6, 7});
}

TEST_CASE("the extended form is read by its columns", "[formats][crd]") {
    const Structure structure = parse_crd(extended_crd, "w.crd");

    REQUIRE(structure.names.size() == 2);
    CHECK(to_string(structure.names[1]) == "WATERSEG TIP3 1 H1");
    CHECK(structure.positions[0] == Vec3(1.0000000001, -2.5, 0));
    CHECK(structure.lines == std::vector<std::size_t>{4, 5});
}

TEST_CASE("a file from another system reads the same", "[formats][crd]") {
    std::string with_carriage_returns;
    for (const char letter : normal) {
        if (letter == '\n') with_carriage_returns += '\r';
        with_carriage_returns += letter;
    }
    const std::vector<std::string> texts{with_carriage_returns, normal + "\n  \n",
                                         normal.substr(0, normal.size() - 1),
                                         normal.substr(normal.find("    4\n"))};
    const std::string& text = texts[GENERATE(0U, 1U, 2U, 3U)];

    const Structure structure = parse_crd(text, "w.crd");

    CHECK(structure.positions == parse_crd(normal, "w.crd").positions);
    CHECK(to_string(structure.names[3]) == "PROA ALA 27A CA");
}

TEST_CASE("the water dimer of the scenes has TIP3P's shape", "[formats][crd]") {
    const Structure dimer = read_crd(test::in_project("scenes/water/dimer.crd"));

    REQUIRE(dimer.positions.size() == 6);
    for (const std::size_t oxygen : {0, 3}) {
        const Vec3 a = dimer.positions[oxygen + 1] - dimer.positions[oxygen];
        const Vec3 b = dimer.positions[oxygen + 2] - dimer.positions[oxygen];
        const double angle = std::acos(a.dot(b) / (a.norm() * b.norm()));
        // The file gives six decimals of each coordinate.
        CHECK(a.norm() == Approx(0.9572).margin(2e-6));
        CHECK(b.norm() == Approx(0.9572).margin(2e-6));
        CHECK(angle * 180 / std::numbers::pi == Approx(104.52).margin(2e-4));
    }
    CHECK(to_string(dimer.names[3]) == "MOV TIP3 1 OH2");
}

TEST_CASE("what is written reads back: names exactly, places to ten decimals", "[formats][crd]") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-9999, 9999);
    Structure structure{.file = "w.crd", .names = {}, .positions = {}, .lines = {}};
    for (int i = 0; i < 50; ++i) {
        structure.names.push_back({i < 20 ? "SEGMENT8" : "B", "RESIDUE8",
                                   std::to_string(1000000 + i / 3),
                                   "ATOM000" + std::to_string(i % 3)});
        structure.positions.emplace_back(uniform(random), uniform(random), uniform(random));
        structure.lines.push_back(static_cast<std::size_t>(i) + 5);
    }

    const std::string text = format_crd(structure, "one\n\nthree");
    const Structure back = parse_crd(text, "w.crd");

    CHECK_THAT(text, StartsWith("* one\n* \n* three\n*\n        50  EXT\n"));
    REQUIRE(back.names.size() == 50);
    for (std::size_t i = 0; i < 50; ++i) {
        CHECK(to_string(back.names[i]) == to_string(structure.names[i]));
        CHECK((back.positions[i] - structure.positions[i]).cwiseAbs().maxCoeff() <= 0.51e-10);
    }
    CHECK(back.lines[0] == 6);
    CHECK(format_crd(back, "one\n\nthree") == text);
}

TEST_CASE("CHARMM's own extended lines are written back letter by letter", "[formats][crd]") {
    CHECK(format_crd(parse_crd(extended_crd, "w.crd"), "TITLE") == extended_crd);
}

TEST_CASE("residues are numbered in their order, over all segments", "[formats][crd]") {
    Structure structure;
    for (const auto& [segment, number] :
         {std::pair("A", "7"), {"A", "7"}, {"A", "8"}, {"B", "8"}, {"B", "8"}}) {
        structure.names.push_back({segment, "R", number, std::to_string(structure.names.size())});
        structure.positions.emplace_back(0, 0, 0);
    }

    const std::string text = format_crd(structure, "");

    std::vector<std::string> residues;
    for (std::size_t at = text.find("EXT\n") + 4; at < text.size(); at = text.find('\n', at) + 1) {
        residues.push_back(text.substr(at + 10, 10));
    }
    CHECK(residues == std::vector<std::string>{"         1", "         1", "         2",
                                               "         3", "         3"});
}

TEST_CASE("a number that does not parse is told with line and column", "[formats][crd]") {
    const std::string bad =
        GENERATE("     x.234", "       nan", "       inf", "      -inf", "**********", "   1.0 2.0",
                 "     1e999", "100000.001", "-1.0001e05");
    INFO(bad);

    CHECK_THAT(error_of(replaced(normal, "   1.95720", bad)),
               StartsWith("w.crd:5:21: ") && Contains("is not a coordinate"));
    CHECK_THAT(error_of(replaced(normal, "  -1.57337", bad)), StartsWith("w.crd:6:31: "));
    CHECK_THAT(error_of(replaced(extended_crd, "        1.9572000000", "          " + bad)),
               StartsWith("w.crd:5:41: "));
}

TEST_CASE("a field that is blank or cut off is told with line and column", "[formats][crd]") {
    CHECK_THAT(error_of(replaced(normal, "TIP3 H1 ", "     H1 ")),
               StartsWith("w.crd:5:12: the residue name is missing"));
    CHECK_THAT(error_of(replaced(normal, "TIP3 H1 ", "TIP3    ")),
               StartsWith("w.crd:5:17: the atom name is missing"));
    CHECK_THAT(
        error_of(replaced(normal, "WATA 1      0.00000\n    3", "     1      0.00000\n    3")),
        StartsWith("w.crd:5:52: the segment name is missing"));
    CHECK_THAT(error_of(replaced(normal, "WATA 1      0.00000\n    3", "WATA\n    3")),
               StartsWith("w.crd:5:57: the residue number is missing"));
    CHECK_THAT(
        error_of(replaced(normal, "  -2.50000   0.00000 WATA", "  -2.50000            WATA")),
        StartsWith("w.crd:5:41: the coordinate is missing"));
    CHECK_THAT(error_of(replaced(normal, "   0.76000  -1.57337   0.00000", std::string(30, ' '))),
               StartsWith("w.crd:6:21: the coordinate is missing"));
    CHECK_THAT(error_of("    1\n\n"), StartsWith("w.crd:2:"));
}

TEST_CASE("missing and surplus atoms are told", "[formats][crd]") {
    CHECK(error_of(replaced(normal, "    4\n", "    5\n")) ==
          "w.crd:7: ends after 4 of the 5 atoms announced on line 3");
    CHECK_THAT(
        error_of(normal.substr(0, normal.find("-1.57337"))),
        StartsWith("w.crd:6:52: the segment name is missing; the file ends here after 2 of the 4 "
                   "atoms announced on line 3"));
    CHECK_THAT(error_of(replaced(normal, "    4\n", "    3\n")),
               StartsWith("w.crd:7: ") && Contains("3 atoms"));
    CHECK_THAT(error_of(normal + "\nmore\n"), StartsWith("w.crd:9: "));
}

TEST_CASE("two atoms of one name are told, both with their lines", "[formats][crd]") {
    CHECK_THAT(error_of(replaced(normal, " H2  ", " H1  ")),
               StartsWith("w.crd:6: ") && Contains("WATA TIP3 1 H1") && Contains("line 5"));
    // The same atom name in another residue is no mistake.
    CHECK(
        error_of(replaced(replaced(normal, " H2  ", " H1  "), "0.00000 WATA 1      0.00000\n    4",
                          "0.00000 WATA 2      0.00000\n    4")) == "no error");
}

TEST_CASE("a file without a count of atoms is told", "[formats][crd]") {
    CHECK_THAT(error_of(""), StartsWith("w.crd: ends before"));
    CHECK_THAT(error_of("* only\n* a title\n"), StartsWith("w.crd:2: ends before"));
    const std::string count = GENERATE("0", "-1", "", "x", "1.5", "1 2", "1 EXT EXT",
                                       "99999999999999999999", "nan", "1EXT");
    INFO("'" << count << "'");
    CHECK_THAT(error_of(replaced(normal, "    4\n", count + "\n")),
               StartsWith("w.crd:3: '" + count + "' is not a number of atoms"));
}

TEST_CASE("a huge count of atoms costs no memory, only an error", "[formats][crd]") {
    const std::string count = GENERATE("9223372036854775807", "99999999999");

    // Room for so many atoms ahead of time would be a bad_alloc or length_error.
    CHECK(error_of(replaced(normal, "    4\n", count + "\n")) ==
          "w.crd:7: ends after 4 of the " + count + " atoms announced on line 3");
    CHECK(error_of(replaced(extended_crd, "2  EXT", count + " EXT")) ==
          "w.crd:5: ends after 2 of the " + count + " atoms announced on line 3");
}

TEST_CASE("a file on disk is named by its path", "[formats][crd]") {
    const test::TemporaryFolder folder;
    const std::string path = folder.add_file("w.crd", "* title\nmany\n").string();

    CHECK_THAT(load_error_of([&] { read_crd(path); }), StartsWith(path + ":2: "));
    CHECK(load_error_of([&] { read_crd(path + "x"); }) == path + "x: no such file");
}

TEST_CASE("CHARMM's own files are read", "[formats][crd]") {
    const auto folder = test::find_shared_data("data/energies");
    if (!folder) return;
    const auto [name, count] =
        GENERATE(table<std::string, std::size_t>({{"crambin_c36m.crd", 642},
                                                  {"ala_ala_ala/ala_ala_ala.crd", 33},
                                                  {"eef1sb/proteins/protein_g.crd", 862},
                                                  {"eef1sb/proteins/ci2.crd", 1064},
                                                  {"eef1sb/proteins/ff_domain.crd", 1158},
                                                  {"eef1sb/proteins/top7.crd", 1862},
                                                  {"eef1sb/proteins/hr4660b.crd", 2888}}));
    INFO(name);

    const Structure structure = read_crd(*folder / name);

    CHECK(structure.names.size() == count);
    const Structure back = parse_crd(format_crd(structure, name), "back.crd");
    CHECK(back.positions == structure.positions);
}

TEST_CASE("weights come back as B-factors, and without any there are none", "[formats][crd]") {
    Structure structure;
    structure.names = {{"A", "ALA", "1", "N"}, {"A", "ALA", "1", "CA"}};
    structure.positions = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
    CHECK(parse_crd(format_crd(structure, "t"), "a.crd").weights.empty());
    CHECK(b_factor_of(structure, 1) == 0);
    structure.records.resize(2);
    structure.records[1].b_factor = 21.5;
    const Structure again = parse_crd(format_crd(structure, "t"), "a.crd");
    CHECK(again.weights == std::vector<double>{0, 21.5});
    CHECK(b_factor_of(again, 1) == 21.5);
}
