#include "formats/mmcif.h"

#include "formats/crd.h"
#include "formats/pdb.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/replaced.h"
#include "tests/support/shared_data.h"

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

// Typed by hand after the PDBx/mmCIF dictionary.
const std::string text = R"(# typed by hand
data_HAND
_entry.id   HAND
_struct.title
;a text field; _atom_site.id and loop_ mean nothing here
;
loop_
_entity.id
_entity.details
1 'with a blank' 2 "don't"
loop_
_atom_site.group_PDB
_atom_site.id
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_alt_id
_atom_site.label_comp_id
_atom_site.label_asym_id
_atom_site.label_entity_id
_atom_site.label_seq_id
_atom_site.pdbx_PDB_ins_code
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
_atom_site.occupancy
_atom_site.B_iso_or_equiv
_atom_site.pdbx_formal_charge
_atom_site.auth_seq_id
_atom_site.auth_comp_id
_atom_site.auth_asym_id
_atom_site.auth_atom_id
_atom_site.pdbx_PDB_model_num
ATOM   1 N  N    . ALA A 1 1 ? 11.104 6.134 -6.504 1.00 10.50 ? 27 ALA H N  1
ATOM   2 C  CA   A ALA A 1 1 ? 11.639 6.071 -5.147 0.60 11.00 ? 27 ALA H CA 1
ATOM   3 C  CA   B ALA A 1 1 ? 11.700 6.200 -5.100 0.40 12.00 ? 27 ALA H CA 1
ATOM   4 O  O    . ALA A 1 2 A -1000  6e1   .5     .    ?     ? 27 ALA H O  1
HETATM 5 CA CA   . CA  B 2 . ? 1.000 2.000
3.000 0.50 20.00 2 101 CA  H CA 1
HETATM 6 ?  "O5'" . XYZ C 3 . ? 4.000 5.000 6.000 1.00 0.00 -1 201 ? XX ? 2
#
)";

// As refinement programs write it: little, and in another order.
const std::string small = R"(data_s
loop_
_atom_site.Cartn_z
_atom_site.Cartn_y
_atom_site.Cartn_x
_atom_site.label_seq_id
_atom_site.label_comp_id
_atom_site.label_asym_id
_atom_site.label_atom_id
3 2 1 7 TIP3 W OH2
6 5 4 7 TIP3 W H1
)";

// One atom, without a loop.
const std::string single = R"(data_s
_atom_site.Cartn_x 1
_atom_site.Cartn_y 2
_atom_site.Cartn_z 3
_atom_site.auth_seq_id 7
_atom_site.label_comp_id ZN
_atom_site.label_asym_id W
_atom_site.label_atom_id ZN
)";

std::string mmcif_error_of(const std::string& cif) {
    return load_error_of([&] { parse_mmcif(cif, "w.cif"); });
}

}  // namespace

TEST_CASE("the atoms of an mmCIF file are read by the names of its columns", "[formats][mmcif]") {
    const Structure structure = parse_mmcif(text, "w.cif");

    REQUIRE(structure.names.size() == 6);
    CHECK(structure.file == "w.cif");
    CHECK(to_string(structure.names[1]) == "H ALA 27 CA");
    CHECK(to_string(structure.names[3]) == "H ALA 27A O");
    CHECK(to_string(structure.names[5]) == "XX XYZ 201 O5'");
    CHECK(structure.positions[3] == Vec3(-1000, 60, 0.5));
    CHECK(structure.positions[4] == Vec3(1, 2, 3));
    // A row over two lines counts where its x stands.
    CHECK(structure.lines == std::vector<std::size_t>{33, 34, 35, 36, 37, 39});
    CHECK(structure.chain_ends == std::vector<std::size_t>{4, 5, 6});

    const std::vector<AtomRecord>& records = structure.records;
    CHECK((records[0].alternate == ' ' && records[1].alternate == 'A'));
    CHECK((records[2].occupancy == 0.4 && records[2].b_factor == 12));
    CHECK((records[3].occupancy == 1 && records[3].b_factor == 0));
    CHECK((records[3].residue_number == 27 && records[3].insertion_code == 'A'));
    CHECK((records[4].element == "CA" && records[4].hetero && records[4].formal_charge == 2));
    CHECK((records[5].element == "O" && records[5].element_guessed && records[5].model == 2));
    CHECK((records[5].chain == "XX" && records[5].formal_charge == -1 && records[5].serial == 6));
    CHECK(structure.notes.size() == 6);
    CHECK(structure.notes.front() == "2 models, numbers 1 to 2");
}

TEST_CASE("where the author names nothing, the archive's names count", "[formats][mmcif]") {
    const Structure structure = parse_mmcif(small, "w.cif");

    REQUIRE(structure.names.size() == 2);
    CHECK(to_string(structure.names[0]) == "W TIP3 7 OH2");
    CHECK(structure.positions[1] == Vec3(4, 5, 6));
    CHECK(structure.records[0].element == "O");
}

TEST_CASE("one atom may stand outside of a loop", "[formats][mmcif]") {
    const Structure structure = parse_mmcif(single, "w.cif");

    REQUIRE(structure.names.size() == 1);
    CHECK(to_string(structure.names[0]) == "W ZN 7 ZN");
    CHECK(structure.positions[0] == Vec3(1, 2, 3));
    CHECK(structure.records[0].element == "ZN");
    CHECK_THAT(mmcif_error_of(replaced(single, " ZN\n_atom_site.label_asym_id W", "\n")),
               StartsWith("w.cif:"));
}

TEST_CASE("what is wrong in an mmCIF file is told with its line and column", "[formats][mmcif]") {
    struct Row {
        const char *old, *by, *error;
    };
    const auto row = GENERATE(values<Row>({
        {"11.104", "11.1x4",
         "w.cif:33:32: '11.1x4' in _atom_site.Cartn_x is not a coordinate within ±100000 Å"},
        {"11.104", "abcdef", "w.cif:33:32: 'abcdef' in _atom_site.Cartn_x is not"},
        {"11.104", "?", "w.cif:33:32: '?' in _atom_site.Cartn_x is not"},
        {"6.134", "'6 1'", "w.cif:33:39: ''6 1'' in _atom_site.Cartn_y is not"},
        {"-6.504", "-100000.1", "w.cif:33:45: '-100000.1' in _atom_site.Cartn_z is not"},
        {"-6.504", "nan", "w.cif:33:45: 'nan' in _atom_site.Cartn_z is not"},
        {"1.00 10.50", "l.00 10.50", "w.cif:33:52: 'l.00' in _atom_site.occupancy is not"},
        {"1.00 10.50", "1.00 10,50", "w.cif:33:57: '10,50' in _atom_site.B_iso_or_equiv is not"},
        {"3.000 0.50", "3.0x0 0.50", "w.cif:38:1: '3.0x0' in _atom_site.Cartn_z is not"},
        {"20.00 2 ", "20.00 2+ ", "w.cif:38:18: '2+' in _atom_site.pdbx_formal_charge is not"},
        {"? 27 ALA", "? 27x ALA", "w.cif:33:65: '27x' in _atom_site.auth_seq_id is not"},
        {"? 27 ALA", "? 99999999999 ALA", "w.cif:33:65: '99999999999' in _atom_site.auth_seq_id"},
        {"CA 1\nATOM   3", "CA x\nATOM   3",
         "w.cif:34:77: 'x' in _atom_site.pdbx_PDB_model_num is not a whole number"},
        {"CA   B ALA", "CA  BC ALA", "w.cif:35:17: 'BC' in _atom_site.label_alt_id is not one"},
        {"ATOM   1 N", "ATOM   1 Q", "w.cif:33: 'Q' is not an element"},
        {"ATOM   1", "ATQM   1", "w.cif:33:1: 'ATQM' in _atom_site.group_PDB is not ATOM or"},
        {"_atom_site.Cartn_y\n", "_atom_site.Cartn_q\n",
         "w.cif:12: the column _atom_site.Cartn_y is missing; expected a coordinate within ±100000 "
         "Å"},
        {"_atom_site.Cartn_y\n", "_atom_site.Cartn_X\n",
         "w.cif:23:1: column _atom_site.Cartn_X is repeated"},
        {" XX ? 2\n", " XX ?\n", "w.cif:39: a row of _atom_site ends after 20 of 21 values"},
        {"data_HAND", "", "w.cif:3:1: is not a CIF file: expected block header (data_)"},
        {"\n;\n", "\n", "w.cif:40:1: is not a CIF file: unterminated text field"},
        {"\"don't\"", "\"don't", "w.cif:10:26: is not a CIF file: unterminated \"string\""},
        {"   HAND\n", "\n", "w.cif:4:1: is not a CIF file: the tag before has no value"},
        {"ATOM   3", "_ATOM   3", "w.cif:"},
        {"ATOM   3", "loop_   3", "w.cif:"},
        {"ATOM   3", "\x01TOM   3", "w.cif:35:1: is not a CIF file"},
    }));
    INFO(row.old << " -> " << row.by);

    CHECK_THAT(mmcif_error_of(replaced(text, row.old, row.by)), StartsWith(row.error));
}

TEST_CASE("one table of atoms is expected, and one there must be", "[formats][mmcif]") {
    CHECK_THAT(mmcif_error_of(""), StartsWith("w.cif: ends without any atom"));
    CHECK_THAT(mmcif_error_of("data_x\n_entry.id x\n"),
               StartsWith("w.cif:2: ends without any atom"));
    CHECK_THAT(mmcif_error_of(small + small.substr(7)),
               StartsWith("w.cif:13:1: a second table of atoms, first on line 3"));
    CHECK_THAT(mmcif_error_of(small + single),
               StartsWith("w.cif:13:1: a second table of atoms, first on line 3"));
    CHECK_THAT(mmcif_error_of("data_x\nloop_\n_atom_site.id\n"), StartsWith("w.cif:"));
    // A dictionary's residue has coordinates as well.
    CHECK_THAT(
        mmcif_error_of("data_comp_X\nloop_\n_chem_comp_atom.atom_id\n_chem_comp_atom.x\nC1 0.5\n"),
        StartsWith("w.cif:3: is a chemical component (_chem_comp_atom"));
}

TEST_CASE("an mmCIF file cut off within its atoms is refused, or the cut is noted",
          "[formats][mmcif]") {
    for (std::size_t length = 0; length < text.find("\n#\n"); ++length) {
        INFO(length);
        const std::string cut = text.substr(0, length);
        const std::string error = mmcif_error_of(cut);
        if (error == "no error") {
            CHECK_THAT(parse_mmcif(cut, "w.cif").notes.front(), StartsWith("ends with its last"));
        } else {
            CHECK_THAT(error, StartsWith("w.cif:"));
        }
    }
}

TEST_CASE("a structure reads the same from PDB and from mmCIF", "[formats][mmcif]") {
    const auto folder = test::find_shared_data("data");
    if (!folder) return;
    const std::string name = GENERATE("structures/1crn.pdb", "hiv/5vea_protein.pdb",
                                      "hiv/1hvr_protein.pdb", "hiv/derived/standin_2az8_tl3.pdb");
    INFO(name);
    const Structure pdb = read_pdb(*folder / name);
    std::string cif = "data_x\nloop_\n";
    for (const char* const tag :
         {"group_PDB", "id", "auth_atom_id", "label_alt_id", "auth_comp_id", "auth_asym_id",
          "auth_seq_id", "pdbx_PDB_ins_code", "Cartn_x", "Cartn_y", "Cartn_z", "occupancy",
          "B_iso_or_equiv", "type_symbol", "pdbx_formal_charge"}) {
        cif += fmt::format("_atom_site.{}\n", tag);
    }
    for (std::size_t i = 0; i < pdb.names.size(); ++i) {
        const AtomRecord& r = pdb.records[i];
        const Vec3& p = pdb.positions[i];
        cif += fmt::format("{} {} \"{}\" {} {} {} {} {} {:.3f} {:.3f} {:.3f} {:.2f} {:.2f} {} {}\n",
                           r.hetero ? "HETATM" : "ATOM", r.serial, pdb.names[i].atom,
                           r.alternate == ' ' ? '.' : r.alternate, pdb.names[i].residue, r.chain,
                           r.residue_number, r.insertion_code == ' ' ? '?' : r.insertion_code,
                           p.x(), p.y(), p.z(), r.occupancy, r.b_factor, r.element,
                           r.formal_charge == 0 ? "?" : fmt::format("{}", r.formal_charge));
    }

    const Structure read = parse_mmcif(cif, "x.cif");

    REQUIRE(read.names.size() == pdb.names.size());
    CHECK(read.positions == pdb.positions);
    for (std::size_t i = 0; i < pdb.names.size(); ++i) {
        const AtomRecord &r = pdb.records[i], &s = read.records[i];
        INFO(to_string(pdb.names[i]));
        CHECK((r.serial == s.serial && r.chain == s.chain && r.hetero == s.hetero));
        CHECK((pdb.names[i].number == read.names[i].number));
        CHECK((pdb.names[i].atom == read.names[i].atom));
        CHECK((pdb.names[i].residue == read.names[i].residue));
        CHECK((r.alternate == s.alternate && r.element == s.element));
        CHECK((r.occupancy == s.occupancy && r.b_factor == s.b_factor));
        CHECK(r.formal_charge == s.formal_charge);
    }
}

TEST_CASE("an mmCIF file is written by its dictionary, with names that need quotes",
          "[formats][mmcif]") {
    Structure structure;
    structure.file = "w.pdb";
    structure.names = {
        {"A", "ALA", "-3A", "CA"}, {"A", "A", "100000", "O5'"}, {"B", "MG", "7", "MG"}};
    structure.positions = {{1.234567, -2, 0}, {99999, 0, -1e-7}, {0, 0, 0}};
    structure.lines = {1, 2, 3};
    structure.records.resize(3);
    for (std::size_t i = 0; i < 3; ++i) structure.records[i].chain = structure.names[i].segment;
    structure.records[0].element = "C";
    structure.records[0].alternate = 'B';
    structure.records[0].occupancy = 0.5;
    structure.records[1].element = "O";
    structure.records[1].b_factor = 12.345;
    structure.records[2].element = "MG";
    structure.records[2].formal_charge = 2;
    structure.records[2].hetero = true;
    structure.records[2].model = 12;
    structure.chain_ends = {1, 2};

    const std::string written = format_mmcif(structure, "my model");

    // Typed by hand.
    CHECK_THAT(written, StartsWith("data_my_model\n#\nloop_\n_atom_site.group_PDB\n"));
    CHECK(written.substr(written.find("ATOM ")) ==
          "ATOM 1 C CA B ALA A ? . A 1.23457 -2.00000 0.00000 0.50 0.00 ? -3 ALA A CA 1\n"
          "ATOM 2 O O5' . A B ? . ? 99999.00000 0.00000 -0.00000 1.00 12.35 ? 100000 A A O5' 1\n"
          "HETATM 3 MG MG . MG A ? . ? 0.00000 0.00000 0.00000 1.00 0.00 2 7 MG B MG 12\n#\n");
}

TEST_CASE("an mmCIF file that is written reads back", "[formats][mmcif]") {
    Structure structure;
    for (const char* const name : {"C1'", "\"C\"", "'C", "_C", "#C", "C#", ";C", "[C", "$C", "C\"'",
                                   "data_C", "LOOP_", "?", "C.", "'C\""}) {
        structure.names.push_back({"SEGMENT8", "RESIDUE8", "1", name});
        structure.positions.emplace_back(1, 2, 3);
    }
    structure.records.resize(structure.names.size());
    for (AtomRecord& record : structure.records) {
        record.element = "C";
        record.chain = "CHAIN_AB";
    }

    const Structure back = parse_mmcif(format_mmcif(structure, ""), "w.cif");

    REQUIRE(back.names.size() == structure.names.size());
    for (std::size_t i = 0; i < back.names.size(); ++i) {
        CHECK(back.names[i].atom == structure.names[i].atom);
        CHECK(back.names[i].residue == "RESIDUE8");
        CHECK(back.records[i].chain == "CHAIN_AB");
        CHECK(back.positions[i] == Vec3(1, 2, 3));
    }
}

TEST_CASE("a structure without records is written with its segments as chains",
          "[formats][mmcif]") {
    const Structure structure = read_crd(test::in_project("scenes/water/dimer.crd"));

    const Structure back = parse_mmcif(format_mmcif(structure, "dimer"), "w.cif");

    REQUIRE(back.names.size() == 6);
    CHECK(back.chain_ends == std::vector<std::size_t>{3, 6});
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(to_string(back.names[i]) == to_string(structure.names[i]));
        CHECK(back.records[i].element == (i % 3 == 0 ? "O" : "H"));
        CHECK((back.positions[i] - structure.positions[i]).cwiseAbs().maxCoeff() < 0.51e-5);
    }
}

TEST_CASE("chains without names are named as the archive does", "[formats][mmcif]") {
    Structure structure;
    for (int i = 0; i < 29; ++i) {
        structure.names.push_back({"", "ION", std::to_string(i), "SOD"});
        structure.positions.emplace_back(i, 0, 0);
        structure.chain_ends.push_back(static_cast<std::size_t>(i) + 1);
    }

    const Structure back = parse_mmcif(format_mmcif(structure, "x"), "w.cif");

    CHECK(back.records[0].chain == "A");
    CHECK(back.records[25].chain == "Z");
    CHECK(back.records[26].chain == "AA");
    CHECK(back.records[27].chain == "BA");
    CHECK(back.chain_ends.size() == 29);
}

TEST_CASE("what cannot be written to an mmCIF file is told", "[formats][mmcif]") {
    Structure structure;
    structure.file = "w.crd";
    structure.names = {{"A", "ALA", "1", "CA"}};
    structure.positions = {{0, 0, 0}};
    structure.lines = {4};
    const auto error_with = [&](const AtomName& name) {
        structure.names[0] = name;
        return load_error_of([&] { format_mmcif(structure, "x"); });
    };

    CHECK(error_with({"A", "ALA", "1", "CA"}) == "no error");
    CHECK_THAT(error_with({"A", "AL A", "1", "CA"}), StartsWith("w.crd:4: 'AL A' of A AL A 1 CA"));
    CHECK_THAT(error_with({"A", "ALA", "1AB", "CA"}),
               Contains("'1AB'") && Contains("is not a residue number"));
    CHECK_THAT(error_with({"A", "ALA", "", "CA"}), Contains("is not a residue number"));
    CHECK_THAT(error_with({"A", "ALA", "1", "1"}), Contains("gives no element"));
}

// By the PDBx/mmCIF dictionary: a loop, and the same as single values.
TEST_CASE("bonds between residues of an mmCIF file are read", "[formats][mmcif]") {
    const std::string loop = R"(loop_
_struct_conn.id
_struct_conn.conn_type_id
_struct_conn.ptnr1_auth_asym_id
_struct_conn.ptnr1_auth_comp_id
_struct_conn.ptnr1_auth_seq_id
_struct_conn.pdbx_ptnr1_PDB_ins_code
_struct_conn.ptnr1_label_atom_id
_struct_conn.ptnr1_symmetry
_struct_conn.ptnr2_auth_asym_id
_struct_conn.ptnr2_auth_comp_id
_struct_conn.ptnr2_auth_seq_id
_struct_conn.ptnr2_label_atom_id
_struct_conn.pdbx_ptnr2_label_alt_id
_struct_conn.ptnr2_symmetry
covale1 covale A ASN 15 B ND2 1_555 A NAG 605 C1 C 1_555
metalc1 metalc A HIS 3 ? NE2 1_555 B ZN 101 ZN ? 2_655
hydrog1 hydrog A DA 1 ? N1 1_555 B DT 2 N3 ? 1_555
)";

    const Structure structure = parse_mmcif(text + loop, "w.cif");

    REQUIRE(structure.links.size() == 1);
    CHECK((structure.links[0].a.number == "15B" && structure.links[0].a.atom == "ND2"));
    CHECK((structure.links[0].b.residue == "NAG" && structure.links[0].b.alternate == 'C'));

    const std::string single =
        "_struct_conn.conn_type_id disulf\n_struct_conn.ptnr1_auth_asym_id A\n"
        "_struct_conn.ptnr1_auth_comp_id CYS\n_struct_conn.ptnr1_auth_seq_id 3\n"
        "_struct_conn.ptnr1_label_atom_id SG\n_struct_conn.ptnr2_auth_asym_id A\n"
        "_struct_conn.ptnr2_auth_comp_id CYS\n_struct_conn.ptnr2_auth_seq_id 40\n"
        "_struct_conn.ptnr2_label_atom_id SG\n";
    const Structure again = parse_mmcif(text + single, "w.cif");
    REQUIRE(again.links.size() == 1);
    CHECK(again.links[0].b.number == "40");
}

TEST_CASE("of atoms that an mmCIF file repeats the first are taken", "[formats][mmcif]") {
    const Structure structure = parse_mmcif(replaced(text, "CA   B ALA", "CA   A ALA"), "w.cif");

    CHECK_THAT(structure.doubts.back(),
               StartsWith("atom chain H ALA 27 CA (location A) of line 34 is repeated on line 35"));
}
