#include "formats/gro.h"

#include "formats/box.h"
#include "formats/index_file.h"
#include "formats/pdb.h"
#include "tests/support/load_error_of.h"
#include "tests/support/trajectory_bytes.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

Structure one_atom(const AtomName& name, const Vec3& position) {
    Structure structure;
    structure.file = "w.pdb";
    structure.names = {name};
    structure.positions = {position};
    structure.lines = {7};
    return structure;
}

std::string gro_error(const AtomName& name, const Vec3& position = Vec3::Zero()) {
    return load_error_of([&] { format_gro(one_atom(name, position), ""); });
}

}  // namespace

TEST_CASE("a GRO file is to the letter what GROMACS writes of the same structure",
          "[formats][gro]") {
    // names.gro is what gmx editconf made of names.pdb.
    const Structure structure = read_pdb(test::trajectory_path("names.pdb"));
    const auto box = find_box_deg({30, 40, 50}, {80, 75, 70});

    CHECK(format_gro(structure, "names for GRO\nand no more", box) ==
          test::bytes_of(test::trajectory_path("names.gro")));
}

TEST_CASE("the box of a GRO file has three numbers where it is rectangular", "[formats][gro]") {
    const Structure structure = one_atom({"W", "TIP3", "1", "OH2"}, {1, 2, 3});
    // By the format of GROMACS's manual.
    const std::string atom = "water\n    1\n    1TIP3   OH2    1   0.100   0.200   0.300\n";

    CHECK(format_gro(structure, "water", find_box_deg({30, 40, 50}, {90, 90, 90})) ==
          atom + "   3.00000   4.00000   5.00000\n");
    CHECK(format_gro(structure, "water") == atom + "   0.00000   0.00000   0.00000\n");
    Mat3 turned = Mat3::Identity();
    turned(2, 0) = 0.1;
    CHECK_THAT(load_error_of([&] { format_gro(structure, "", turned); }),
               Contains("a box that a GRO file cannot tell"));
}

TEST_CASE("numbers of a GRO file begin again behind 99999", "[formats][gro]") {
    Structure structure;
    for (int i = 1; i <= 100'001; ++i) {
        structure.names.push_back({"W", "TIP3", std::to_string(i), "OH2"});
        structure.positions.emplace_back(0, 0, 0);
    }

    const std::string text = format_gro(structure, "");

    CHECK_THAT(text, Contains("\n100001\n") && Contains("\n99999TIP3   OH299999 ") &&
                         Contains("\n    0TIP3   OH2    0 ") &&
                         Contains("\n    1TIP3   OH2    1 "));
    // All lines as long as each other.
    CHECK(text.size() == 1 + 7 + 100'001 * 45 + 31);
}

TEST_CASE("what does not fit a GRO file is reported", "[formats][gro]") {
    CHECK(gro_error({"A", "RESIDUE", "1", "CA"}) ==
          "w.pdb:7: A RESIDUE 1 CA: the residue name 'RESIDUE' does not fit the 5 columns of a GRO "
          "file");
    CHECK_THAT(gro_error({"A", "ALA", "1", "ATOM00"}), Contains("the atom name 'ATOM00'"));
    CHECK_THAT(gro_error({"A", "ALA", "x", "CA"}), Contains("'x' is not a residue number"));
    CHECK_THAT(gro_error({"A", "ALA", "-10000", "CA"}), Contains("'-10000'"));
    CHECK_THAT(gro_error({"A", "ALA", "1", "CA"}, {0, 1e5, 0}),
               Contains("the coordinate 100000 Å"));
    CHECK_THAT(gro_error({"A", "ALA", "1", "CA"}, {0, -1e4, 0}), Contains("-10000"));
    CHECK(gro_error({"A", "ALA", "1", "CA"}, {0, 99999, -9999.99}) == "no error");
    const std::string two =
        "MODEL        1\nATOM      1  C   ALA A   1       1.000   2.000   3.000\nENDMDL\n"
        "MODEL        2\nATOM      1  C   ALA A   1       1.000   2.000   3.000\nENDMDL\nEND\n";
    CHECK_THAT(load_error_of([&] { format_gro(parse_pdb(two, "w.pdb"), ""); }),
               Contains("several models"));
}

TEST_CASE("a GRO file is read as it was written", "[formats][gro]") {
    const Structure written = read_pdb(test::trajectory_path("names.pdb"));
    const Structure read = read_gro(test::trajectory_path("names.gro"));

    REQUIRE(read.names.size() == written.names.size());
    for (std::size_t i = 0; i < read.names.size(); ++i) {
        CHECK(read.names[i].atom == written.names[i].atom);
        CHECK(read.names[i].residue == written.names[i].residue);
        CHECK((read.positions[i] - written.positions[i]).cwiseAbs().maxCoeff() < 0.0051);
    }
}

TEST_CASE("coordinates of a GRO file may have more digits", "[formats][gro]") {
    const Structure read = parse_gro(
        "precise\n    1\n    1LIG     C1    1   0.100005   0.200000  -1.234567  0.1 0.2 0.3\n"
        "   1 1 1\n",
        "p.gro");

    CHECK((read.positions[0] - Vec3(1.00005, 2, -12.34567)).norm() < 1e-12);
}

TEST_CASE("segments of a GRO file are runs of water, ions and molecules", "[formats][gro]") {
    const auto atom = [](int number, const char* residue, const char* name) {
        return fmt::format("{:5}{:<5}{:>5}{:5}{:8.3f}{:8.3f}{:8.3f}\n", number, residue, name, 1,
                           0., 0., 0.);
    };
    const std::string atoms = atom(1, "ALA", "N") + atom(1, "ALA", "CA") + atom(2, "GLY", "N") +
                              atom(2, "GLY", "CA") + atom(1, "ALA", "N") + atom(1, "ALA", "CA") +
                              atom(3, "SOL", "OW") + atom(3, "SOL", "HW1") + atom(4, "NA", "NA") +
                              atom(5, "CL", "CL") + atom(6, "SOL", "OW") + atom(6, "SOL", "HW1");
    const Structure read = parse_gro("many\n12\n" + atoms + "1 1 1\n", "m.gro");

    std::vector<std::string> segments;
    for (const AtomName& name : read.names) segments.push_back(name.segment);
    CHECK(segments == std::vector<std::string>{"M1", "M1", "M1", "M1", "M2", "M2", "WAT", "WAT",
                                               "ION", "ION", "WAT2", "WAT2"});
}

TEST_CASE("a GRO file that cannot be read is refused with its line", "[formats][gro]") {
    const std::string atom = "    1TIP3   OH2    1   0.100   0.200   0.300\n";
    const auto error = [](const std::string& text) {
        return load_error_of([&] { (void)parse_gro(text, "w.gro"); });
    };
    CHECK_THAT(error(""), Contains("is empty"));
    CHECK_THAT(error("t\nmany\n"), Contains("w.gro:2") && Contains("'many' is not a number of"));
    CHECK_THAT(error("t\n2\n" + atom), Contains("ends after 1 of 2 atoms"));
    CHECK_THAT(error("t\n1\n" + atom), Contains("no line of the box"));
    CHECK_THAT(error("t\n1\n" + atom + "1 1 1\n" + atom), Contains("expected one frame"));
    CHECK_THAT(error("t\n1\n    1TIP3   OH2    1   0.100   0.2\n1 1 1\n"),
               Contains("w.gro:3") && Contains("is not a coordinate"));
    CHECK_THAT(error("t\n1\n    1TIP3   OH2    1   0,100\n1 1 1\n"), Contains("three coordinates"));
    CHECK_THAT(error("t\n1\n    xTIP3   OH2    1   0.100   0.200   0.300\n1 1 1\n"),
               Contains("'x' is not a residue number"));
}

TEST_CASE("groups of an index file", "[formats][gro]") {
    const auto groups =
        parse_index_file("; by hand\n[ System ]\n1 2 3\n 4\n\n[ two words ] ; 9\n7\n", "i.ndx");

    REQUIRE(groups.size() == 2);
    CHECK(groups[0].name == "System");
    CHECK(groups[0].atoms == std::vector<std::uint32_t>{0, 1, 2, 3});
    CHECK(groups[1].name == "two words");
    CHECK(groups[1].atoms == std::vector<std::uint32_t>{6});
    CHECK(groups[1].line == 6);
    const auto error = [](const std::string& text) {
        return load_error_of([&] { (void)parse_index_file(text, "i.ndx"); });
    };
    CHECK_THAT(error(""), Contains("has no group"));
    CHECK_THAT(error("1 2"), Contains("before the first group"));
    CHECK_THAT(error("[ a ]\n0"), Contains("i.ndx:2") && Contains("'0' is not an atom number"));
    CHECK_THAT(error("[ a"), Contains("is not the name of a group"));
}

TEST_CASE("a GRO file of more decimals has wider columns", "[formats][gro]") {
    const std::string gro =
        format_gro(one_atom({"A", "ALA", "1", "CA"}, Vec3(1.23456789012, -20, 0)), "", {}, 9);
    CHECK_THAT(gro, Contains("   CA    1   0.123456789  -2.000000000   0.000000000\n"));
}
