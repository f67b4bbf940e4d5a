#include "formats/pdb.h"

#include "formats/crd.h"
#include "tests/support/load_error_of.h"
#include "tests/support/replaced.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cstddef>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;
using test::load_error_of;
using test::replaced;

namespace {

// Typed by hand after the format's description 3.3: alternate locations, an insertion code, a
// chain's end, calcium beside a C-alpha, a charge, coordinates that touch.
const std::string pdb_text = R"(HEADER    TYPED BY HAND
REMARK   1 ATOM  IS NO ATOM HERE
ATOM      1  N   ALA A  27      11.104   6.134  -6.504  1.00 10.50           N
ATOM      2  CA AALA A  27      11.639   6.071  -5.147  0.60 11.00           C
ATOM      3  CA BALA A  27      11.700   6.200  -5.100  0.40 12.00           C
ANISOU    3  CA BALA A  27     1000   1000   1000      0      0      0       C
ATOM      4  O   ALA A  27A   -999.999-999.999-999.999  1.00 99.99           O
ATOM      5 HH11 ARG A  -3       0.000   0.000   0.000  1.00  0.00      PROA H
TER       6      ARG A  -3
HETATM    7 CA    CA B 101       1.000   2.000   3.000  0.50 20.00          CA2+
HETATM    8  O   HOH B 201       4.000   5.000   6.000
CONECT    7    8
END
)";

std::string atom_line(const std::string& serial, const std::string& number, const std::string& x,
                      const std::string& rest = "   6.134  -6.504") {
    return fmt::format("ATOM  {:>5}  N   ALA A{:>4}    {:>8}{}\n", serial, number, x, rest);
}

std::string pdb_error_of(const std::string& pdb) {
    return load_error_of([&] { parse_pdb(pdb, "w.pdb"); });
}

void check_same(const Structure& a, const Structure& b) {
    REQUIRE(a.names.size() == b.names.size());
    CHECK(a.positions == b.positions);
    CHECK(a.chain_ends == b.chain_ends);
    for (std::size_t i = 0; i < a.names.size(); ++i) {
        INFO(i);
        const AtomRecord &r = a.records[i], &s = b.records[i];
        CHECK(to_string(a.names[i]) == to_string(b.names[i]));
        CHECK((r.model == s.model && r.chain == s.chain && r.residue_number == s.residue_number));
        CHECK((r.insertion_code == s.insertion_code && r.alternate == s.alternate));
        CHECK((r.hetero == s.hetero && r.element == s.element));
        CHECK((r.formal_charge == s.formal_charge && r.occupancy == s.occupancy));
        CHECK(r.b_factor == s.b_factor);
    }
}

}  // namespace

TEST_CASE("a PDB file is read by its columns", "[formats][pdb]") {
    const Structure structure = parse_pdb(pdb_text, "w.pdb");

    REQUIRE(structure.names.size() == 7);
    REQUIRE(structure.records.size() == 7);
    CHECK(structure.file == "w.pdb");
    CHECK(structure.lines == std::vector<std::size_t>{3, 4, 5, 7, 8, 10, 11});
    CHECK(to_string(structure.names[1]) == "A ALA 27 CA");
    CHECK(to_string(structure.names[3]) == "A ALA 27A O");
    CHECK(to_string(structure.names[4]) == "PROA ARG -3 HH11");
    CHECK(structure.positions[0] == Vec3(11.104, 6.134, -6.504));
    CHECK(structure.positions[3] == Vec3(-999.999, -999.999, -999.999));
    CHECK(structure.chain_ends == std::vector<std::size_t>{5});

    const std::vector<AtomRecord>& records = structure.records;
    CHECK(records[0].alternate == ' ');
    CHECK((records[1].alternate == 'A' && records[2].alternate == 'B'));
    CHECK((records[1].occupancy == 0.6 && records[1].b_factor == 11));
    CHECK((records[3].residue_number == 27 && records[3].insertion_code == 'A'));
    CHECK((records[4].chain == "A" && records[4].residue_number == -3));
    CHECK((records[5].element == "CA" && records[5].formal_charge == 2 && records[5].hetero));
    CHECK(records[5].serial == 7);
    // What a short line leaves out.
    CHECK((records[6].occupancy == 1 && records[6].b_factor == 0 && records[6].element == "O"));
    CHECK((records[6].element_guessed && !records[5].element_guessed));
    CHECK((records[0].model == 1 && !records[0].hetero));
}

TEST_CASE("what a user must decide is noted", "[formats][pdb]") {
    const std::vector<std::string> notes = parse_pdb(pdb_text, "w.pdb").notes;
    REQUIRE(notes.size() == 5);
    CHECK(notes[0] ==
          "2 atoms in alternate locations, the first on line 4: chain A ALA 27 CA (location A)");
    CHECK(notes[1] ==
          "1 atom in residues with insertion codes, the first on line 7: chain A ALA 27A O");
    CHECK(notes[2] == "1 HETATM atom of CA");
    CHECK(notes[3] == "1 HETATM atom of HOH");
    CHECK_THAT(notes[4], StartsWith("1 atom without an element symbol (element guessed from the "
                                    "atom name), the first on line 11: chain B HOH 201 O"));

    const std::string plain = atom_line("1", "1", "1.000");
    CHECK(parse_pdb(plain + "FOOBAR\n", "w.pdb").notes.front() ==
          "no END record: the file may be cut off");
    CHECK(parse_pdb(plain + "FOOBAR\nEND\n", "w.pdb").notes.front() ==
          "records left out as unknown: FOOBAR");
}

TEST_CASE("models are read one behind the other", "[formats][pdb]") {
    const std::string atom = atom_line("1", "1", "1.000");
    const std::string models =
        "MODEL        1\n" + atom + "ENDMDL\nMODEL        3\n" + atom + "ENDMDL\nEND\n";

    const Structure structure = parse_pdb(models, "w.pdb");

    REQUIRE(structure.names.size() == 2);
    CHECK((structure.records[0].model == 1 && structure.records[1].model == 3));
    CHECK(structure.notes.front() == "2 models, numbers 1 to 3");
    check_same(parse_pdb(format_pdb(structure, ""), "back.pdb"), structure);
    CHECK_THAT(pdb_error_of(replaced(models, "MODEL        3\n", "")),
               StartsWith("w.pdb:5: ENDMDL"));
    CHECK_THAT(pdb_error_of(replaced(models, "ENDMDL\nMODEL", "MODEL")),
               StartsWith("w.pdb:3: a MODEL inside the model of line 1"));
    CHECK_THAT(pdb_error_of(replaced(models, "       3", "       1")),
               StartsWith("w.pdb:4: model 1 again"));
    CHECK_THAT(pdb_error_of(replaced(models, "       3", "       x")),
               StartsWith("w.pdb:4:11: 'x' in columns 11 to 14 is not a model number"));
    CHECK_THAT(pdb_error_of(replaced(models, "ENDMDL\nEND\n", "END\n")),
               StartsWith("w.pdb:6: ends within the model of line 4"));
}

TEST_CASE("numbers that outgrow their columns are read as other programs write them",
          "[formats][pdb]") {
    struct Row {
        const char* columns_6_to_12;
        std::int64_t serial;
    };
    const auto row = GENERATE(values<Row>({{" 99999 ", 99999},
                                           {" A0000 ", 100'000},
                                           {" A0001 ", 100'001},
                                           {" ZZZZZ ", 43'770'015},
                                           {" a0000 ", 43'770'016},
                                           {" 186a0 ", 100'000},
                                           {" ***** ", 1},
                                           {" 00000 ", 0},
                                           {"123456 ", 123'456},
                                           {" 123456", 123'456}}));
    INFO(row.columns_6_to_12);
    const std::string line =
        "ATOM " + std::string(row.columns_6_to_12) + " N   ALA A   1       1.000   2.000   3.000\n";

    CHECK(parse_pdb(line, "w.pdb").records[0].serial == row.serial);
}

TEST_CASE("residue numbers go on beyond 9999", "[formats][pdb]") {
    std::string lines = atom_line("1", "9998", "1.000") + atom_line("2", "9999", "1.000");
    std::string last = "10000";
    SECTION("in hybrid-36") { lines += atom_line("3", "A000", "1.000"); }
    SECTION("with a fifth digit") {
        lines += replaced(atom_line("3", "9999", "1.000"), "9999 ", "10000");
    }
    SECTION("starting over") { lines += atom_line("3", "0", "1.000"); }
    SECTION("with an insertion code") {
        lines += replaced(atom_line("3", "9999", "1.000"), "9999 ", "9999B");
        last = "9999B";
    }

    const Structure structure = parse_pdb(lines, "w.pdb");

    CHECK(structure.names[2].number == last);
    check_same(parse_pdb(format_pdb(structure, "x"), "back.pdb"), structure);
}

TEST_CASE("what is wrong in a PDB file is told with line, columns and what would be right",
          "[formats][pdb]") {
    struct Row {
        const char *old, *by, *error;
    };
    const auto row = GENERATE(values<Row>({
        {"  11.104", "  11.1x4",
         "w.pdb:3:31: '11.1x4' in columns 31 to 38 is not a coordinate; expected a number within "
         "±100000 Å"},
        {"  11.104", "  abcdef", "w.pdb:3:31: 'abcdef' in columns 31 to 38 is not a coordinate"},
        {"  11.104", "  11. 04", "w.pdb:3:31: '11. 04' in columns 31 to 38 is not a coordinate"},
        {"  11.104", "        ", "w.pdb:3:31: '' in columns 31 to 38 is not a coordinate"},
        {"  11.104", "     nan", "w.pdb:3:31: 'nan' in columns 31 to 38"},
        {"  11.104", "   11.104", "w.pdb:3:39: '4   6.13' in columns 39 to 46 is not a coordinate"},
        {"  11.104", "  1.1e05", "w.pdb:3:31: '1.1e05' in columns 31 to 38 is not a coordinate"},
        {"  -6.504", "-1000000", "w.pdb:3:47: '-1000000' in columns 47 to 54 is not a coordinate"},
        {"   6.134", "     inf", "w.pdb:3:39: 'inf' in columns 39 to 46"},
        {"  -6.504", "  -6,504", "w.pdb:3:47: '-6,504' in columns 47 to 54"},
        {"  1.00 10.50", "  l.00 10.50",
         "w.pdb:3:55: 'l.00' in columns 55 to 60 is not an occupancy"},
        {"  1.00 10.50", "  1.00******",
         "w.pdb:3:61: '******' in columns 61 to 66 is not a B-factor"},
        {"           N\n", "           Q\n",
         "w.pdb:3: 'Q' is not an element; expected a symbol such as C or MG"},
        {"CA2+", "CA++", "w.pdb:10:79: '++' in columns 79 to 80 is not a charge"},
        {"      1  N ", "      x  N ", "w.pdb:3:7: 'x' in columns 7 to 11 is not an atom serial"},
        {"  N   ALA", "  \x1bN  ALA",
         "w.pdb:3:13: '\\x1bN' in columns 13 to 16 is not an atom name"},
        {"  N   ALA", "      ALA", "w.pdb:3:13: '' in columns 13 to 16 is not an atom name"},
        {"  N   ALA", "  N A ALA", "w.pdb:3:13: 'N A' in columns 13 to 16 is not an atom name"},
        {"  N   ALA", "  N      ", "w.pdb:3:18: '' in columns 18 to 21 is not a residue name"},
        {"A  27      11", "A  2x      11", "w.pdb:3:23: '2x' in columns 23 to 26 is not a residue"},
        {"A  27      11", "A          11", "w.pdb:3:23: '' in columns 23 to 26 is not a residue"},
        {"A  27      11", "A  27?     11", "w.pdb:3:27: '?' in column 27 is not an insertion code"},
        {"  CA BALA", "  CA AGLY",
         "w.pdb:5: atom chain A GLY 27 CA (location A) is repeated, first on line 4"},
        {"ATOM      1", "ATQM      1",
         "w.pdb:3: 'ATQM' in columns 1 to 6 is not a record; did you "
         "mean 'ATOM'?"},
        {"ATOM      1", " ATOM     1", "w.pdb:3: 'ATOM' in columns 1 to 6 is not a record"},
        {"ATOM      1", "atom      1", "w.pdb:3: 'atom' in columns 1 to 6 is not a record"},
        {"HEADER    T", "END\n       T", "w.pdb:4: an atom after the END of line 1"},
        {"HEADER    T", "ENDMDL\n    T", "w.pdb:1: ENDMDL without a MODEL"},
    }));
    INFO(row.old << " -> " << row.by);

    CHECK_THAT(pdb_error_of(replaced(pdb_text, row.old, row.by)), StartsWith(row.error));
}

TEST_CASE("of atoms that a PDB file repeats the first are taken", "[formats][pdb]") {
    const Structure structure = parse_pdb(replaced(pdb_text, "  CA BALA", "  CA AALA"), "w.pdb");

    CHECK(structure.names.size() == parse_pdb(pdb_text, "w.pdb").names.size() - 1);
    CHECK(structure.positions[1].x() == 11.639);
    CHECK_THAT(structure.doubts.back(),
               StartsWith("atom chain A ALA 27 CA (location A) of line 4 is repeated on line 5"));

    std::string many;
    for (int i = 0; i < 60; ++i) many += atom_line("1", "7", "1.000");
    CHECK_THAT(pdb_error_of(many), StartsWith("w.pdb:52: atom chain A ALA 7 N is repeated"));
}

// Columns by the format's description 3.3; the third is to a copy by symmetry.
TEST_CASE("LINK and SSBOND of a PDB file are read", "[formats][pdb]") {
    const std::string links =
        "HETNAM     NAG 2-ACETAMIDO-2-DEOXY-BETA-D-\nHETNAM   2 NAG  GLUCOPYRANOSE\n"
        "LINK         ND2 ASN A  15A                C1 BNAG A 605     1555   1555  1.44\n"
        "SSBOND   1 CYS A   -2    CYS B   12                          1555   1555  2.02\n"
        "LINK         S   22Q A   1                CU   CU1 B 101     1555   6345  2.26\n"
        "LINK     nonsense\nSSBOND\nLINK\n";

    const Structure structure = parse_pdb(links + pdb_text, "w.pdb");

    REQUIRE(structure.links.size() == 2);
    const LinkedAtom& one = structure.links[0].a;
    CHECK((one.chain == "A" && one.residue == "ASN" && one.number == "15A" && one.atom == "ND2"));
    const LinkedAtom& other = structure.links[0].b;
    CHECK((other.number == "605" && other.atom == "C1" && other.alternate == 'B'));
    CHECK(structure.links[0].line == 3);
    CHECK((structure.links[1].a.atom == "SG" && structure.links[1].a.number == "-2"));
    CHECK((structure.links[1].b.chain == "B" && structure.links[1].b.number == "12"));
    CHECK(structure.component_names.at("NAG") == "2-ACETAMIDO-2-DEOXY-BETA-D-GLUCOPYRANOSE");
}

TEST_CASE("a PDB file without atoms is refused", "[formats][pdb]") {
    CHECK(pdb_error_of("") == "w.pdb: ends without any atom");
    CHECK(pdb_error_of("HEADER\nEND\n") == "w.pdb:2: ends without any atom");
}

TEST_CASE("a PDB file cut off within an atom is refused, or the cut is noted", "[formats][pdb]") {
    for (std::size_t length = 0; length + 4 < pdb_text.size(); ++length) {
        const std::string cut = pdb_text.substr(0, length);
        INFO(length);
        const std::string error = pdb_error_of(cut);
        if (error != "no error") {
            CHECK_THAT(error, StartsWith("w.pdb:"));
            continue;
        }
        CHECK_THAT(parse_pdb(cut, "w.pdb").notes.front(), StartsWith("no END record"));
    }
}

TEST_CASE("the same atom in another segment is another atom", "[formats][pdb]") {
    // CHARMM writes segments, and no chains.
    const std::string line =
        "ATOM      1  CA  ALA     1       1.000   2.000   3.000  1.00  0.00      PROA\n";

    const Structure structure = parse_pdb(line + replaced(line, "PROA", "PROB"), "w.pdb");

    CHECK(to_string(structure.names[1]) == "PROB ALA 1 CA");
    CHECK(structure.records[1].chain.empty());
    CHECK(structure.records[1].element == "C");
    check_same(parse_pdb(format_pdb(structure, ""), "back.pdb"), structure);
}

TEST_CASE("a PDB file that is written reads the same", "[formats][pdb]") {
    const Structure structure = parse_pdb(pdb_text, "w.pdb");

    const std::string written = format_pdb(structure, "one\ntwo");

    CHECK_THAT(written, StartsWith("REMARK   1 one\nREMARK   1 two\nATOM      1  N   ALA A  27    "
                                   "  11.104   6.134  -6.504  1.00 10.50           N\n"));
    CHECK_THAT(written, Contains("\nTER       6      ARG A  -3\nHETATM    7 CA    CA B 101 "));
    check_same(parse_pdb(written, "back.pdb"), structure);
}

TEST_CASE("a structure from a CRD file is written with segments, without chains",
          "[formats][pdb]") {
    const Structure structure = parse_crd(
        "* X\n*\n    1\n"
        "    1    1 TIP3 OH2    1.00000  -2.50000   0.00001 WATA 1      0.00000\n",
        "w.crd");

    CHECK(format_pdb(structure, "") ==
          "ATOM      1  OH2 TIP3    1       1.000  -2.500   0.000  1.00  0.00      WATA\nEND\n");
}

TEST_CASE("residue numbers that outgrow their columns are written in hybrid-36", "[formats][pdb]") {
    // R. W. Grosse-Kunstleve's tables of hybrid-36.
    struct Row {
        const char *number, *columns_23_to_26;
    };
    const auto row = GENERATE(values<Row>({{"-999", "-999"},
                                           {"9999", "9999"},
                                           {"10000", "A000"},
                                           {"10035", "A00Z"},
                                           {"10036", "A010"},
                                           {"1223055", "ZZZZ"},
                                           {"1223056", "a000"},
                                           {"2436111", "zzzz"},
                                           {"2436112", nullptr}}));
    INFO(row.number);
    Structure structure = parse_pdb(pdb_text, "w.pdb");
    for (AtomName& name : structure.names) name.number = row.number;

    if (!row.columns_23_to_26) {
        CHECK_THAT(load_error_of([&] { format_pdb(structure, ""); }), Contains("residue number"));
        return;
    }
    CHECK(format_pdb(structure, "").substr(22, 4) == row.columns_23_to_26);
}

TEST_CASE("what does not fit the columns is not written", "[formats][pdb]") {
    Structure structure = parse_pdb(pdb_text, "w.pdb");
    std::string error;
    SECTION("coordinate") {
        structure.positions[1].y() = 10000;
        error = "w.pdb:4: the coordinate of A ALA 27 CA, '10000.000', does not fit the 8 columns";
    }
    SECTION("atom name") {
        structure.names[1].atom = "CARBON";
        error = "w.pdb:4: the atom name of A ALA 27 CARBON";
    }
    SECTION("chain") {
        structure.records[1].chain = "AA";
        error = "w.pdb:4: the chain of";
    }
    SECTION("residue number") {
        structure.names[1].number = "-1000";
        error = "w.pdb:4: the residue number of";
    }

    CHECK_THAT(load_error_of([&] { format_pdb(structure, ""); }), StartsWith(error));
}
