#include "prepare/assembly.h"

#include "core/files.h"
#include "core/text.h"
#include "formats/mmcif.h"
#include "formats/pdb.h"
#include "prepare/choose.h"
#include "tests/prepare/small_system.h"
#include "tests/support/load_error_of.h"
#include "tests/support/replaced.h"
#include "tests/support/shared_data.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;
using test::replaced;
using test::StructureWriter;

namespace {

const SymmetryOperator identity{"1", Mat3::Identity(), Vec3::Zero(), 0};

Mat3 diagonal(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

SymmetryOperator translation(const std::string& name, double x) {
    return {name, Mat3::Identity(), Vec3(x, 0, 0), 0};
}

// Chains copied by all of the operators, as assembly 1.
Structure with_assembly(Structure structure, const std::string& chains,
                        const std::vector<SymmetryOperator>& operators) {
    structure.operators = operators;
    std::vector<std::uint32_t> list(operators.size());
    for (std::uint32_t i = 0; i < list.size(); ++i) list[i] = i;
    structure.assemblies = {{"1", {{chains, {list}}}}};
    return structure;
}

// "A1N" and so on, an atom each.
std::vector<std::string> atoms_of(const Structure& structure) {
    std::vector<std::string> atoms;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        const AtomName& name = structure.names[i];
        CHECK(name.segment == structure.records[i].chain);
        atoms.push_back(structure.records[i].chain + name.number + name.atom);
    }
    return atoms;
}

// A residue, a ligand across the two-fold axis z, an ion on it and a calcium beside it.
const std::string pdb = R"(REMARK 350 BIOMOLECULE: 1
REMARK 350 APPLY THE FOLLOWING TO CHAINS: A
REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000
REMARK 350   BIOMT1   2 -1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   2  0.000000 -1.000000  0.000000        0.00000
REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        0.00000
ATOM      1  N   ALA A   1      10.000   0.000   5.000  1.00 10.50           N
ATOM      2  CA  ALA A   1      11.000   1.000   5.000  1.00 10.50           C
ATOM      3  C   ALA A   1      12.000   0.000   5.000  1.00 10.50           C
TER       4      ALA A   1
HETATM    5  C1  LIG A 101      -1.000   0.000   1.000  0.50 10.50           C
HETATM    6  C2  LIG A 101       0.300   0.000   1.000  0.50 10.50           C
HETATM    7  C3  LIG A 101       1.500   0.000   1.000  0.50 10.50           C
HETATM    8 CL    CL A 102       0.000   0.000   9.000  1.00 10.50          CL
HETATM    9 CA    CA A 103       5.000   0.000   9.000  1.00 10.50          CA
HETATM   10  O   HOH A 201       0.000   0.100  20.000  0.50 10.50           O
END
)";

const std::string cif = R"(data_HAND
_pdbx_struct_assembly_gen.assembly_id 1
_pdbx_struct_assembly_gen.oper_expression 1,2
_pdbx_struct_assembly_gen.asym_id_list A,B,C,D,E
loop_
_pdbx_struct_oper_list.id
_pdbx_struct_oper_list.matrix[1][1]
_pdbx_struct_oper_list.matrix[1][2]
_pdbx_struct_oper_list.matrix[1][3]
_pdbx_struct_oper_list.matrix[2][1]
_pdbx_struct_oper_list.matrix[2][2]
_pdbx_struct_oper_list.matrix[2][3]
_pdbx_struct_oper_list.matrix[3][1]
_pdbx_struct_oper_list.matrix[3][2]
_pdbx_struct_oper_list.matrix[3][3]
_pdbx_struct_oper_list.vector[1]
_pdbx_struct_oper_list.vector[2]
_pdbx_struct_oper_list.vector[3]
1 1 0 0 0 1 0 0 0 1 0 0 0
2 -1 0 0 0 -1 0 0 0 1 0 0 0
loop_
_atom_site.group_PDB
_atom_site.id
_atom_site.auth_atom_id
_atom_site.auth_comp_id
_atom_site.label_asym_id
_atom_site.auth_asym_id
_atom_site.auth_seq_id
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
_atom_site.occupancy
_atom_site.type_symbol
ATOM 1 N  ALA A A 1 10.0 0.0 5.0 1.00 N
ATOM 2 CA ALA A A 1 11.0 1.0 5.0 1.00 C
ATOM 3 C  ALA A A 1 12.0 0.0 5.0 1.00 C
HETATM 4 C1 LIG B A 101 -1.0 0.0 1.0 0.50 C
HETATM 5 C2 LIG B A 101  0.3 0.0 1.0 0.50 C
HETATM 6 C3 LIG B A 101  1.5 0.0 1.0 0.50 C
HETATM 7 CL CL  C A 102  0.0 0.0 9.0 1.00 CL
HETATM 8 CA CA  D A 103  5.0 0.0 9.0 1.00 CA
HETATM 9 O  HOH E A 201  0.0 0.1 20.0 0.50 O
#
)";

const std::vector<std::string> whole{"A1N",    "A1CA",   "A1C",    "A101C1", "A101C2",
                                     "A101C3", "A102CL", "A103CA", "A201O",  "B1N",
                                     "B1CA",   "B1C",    "B103CA"};

}  // namespace

TEST_CASE("PDB and mmCIF give the same assembly, what lies on the axis once",
          "[prepare][assembly]") {
    for (const Structure& structure : {parse_pdb(pdb, "w.pdb"), parse_mmcif(cif, "w.cif")}) {
        INFO(structure.file);
        Report report;
        const Structure built = build_assembly(structure, 1, report);
        CHECK(atoms_of(built) == whole);
        // By hand: (x, y, z) -> (-x, -y, z).
        CHECK(built.positions[1] == Vec3(11, 1, 5));
        CHECK(built.positions[10] == Vec3(-11, -1, 5));
        CHECK(built.positions[12] == Vec3(-5, 0, 9));
        CHECK(built.chain_ends.front() == 3);
        CHECK(built.chain_ends.back() == built.names.size());
        CHECK(std::count(built.chain_ends.begin(), built.chain_ends.end(), 9) == 1);
        CHECK(std::count(built.chain_ends.begin(), built.chain_ends.end(), 12) == 1);
        const std::string text = report.to_text();
        CHECK_THAT(text, Contains("chain B: chain A by operator 2\n"));
        CHECK_THAT(text, Contains("LIG A 101 lies on a symmetry axis: 3 of its 3 heavy atoms come "
                                  "within 1.5 Å of it by operator 2; only the original is kept; "
                                  "its occupancy is 1/2, as on a two-fold axis\n"));
        CHECK_THAT(text, Contains("CL A 102 lies on a symmetry axis: 1 of its 1 heavy atoms come "
                                  "within 1.5 Å of it by operator 2; only the original is kept\n"));
        CHECK_THAT(text, Contains("left out 1 copy of waters on a symmetry axis\n"));
        CHECK(report.warnings().empty());
    }
}

TEST_CASE("an mmCIF assembly takes the archive's chains, not the author's", "[prepare][assembly]") {
    Report report;
    const Structure structure = parse_mmcif(replaced(cif, "A,B,C,D,E", "A,D"), "w.cif");
    CHECK(atoms_of(build_assembly(structure, 1, report)) ==
          std::vector<std::string>{"A1N", "A1CA", "A1C", "A103CA", "B1N", "B1CA", "B1C", "B103CA"});
}

TEST_CASE("chain B of HIV-1 protease 5VEA is chain A by the crystal's two-fold",
          "[prepare][assembly]") {
    // The halves of the ligand do not touch: both are kept.
    const auto [name, atoms] = GENERATE(table<std::string, std::size_t>(
        {{"data/hiv/5vea_protein.pdb", 1540}, {"data/hiv/5vea_ligand.pdb", 66}}));
    INFO(name);
    const auto path = test::find_shared_data(name);
    if (!path) return;
    const std::string text = read_text_file(*path);
    const double half_root = std::sqrt(3.0) / 2;
    std::string one_chain = "REMARK 350 BIOMOLECULE: 1\n";
    one_chain += "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n";
    const std::vector<std::vector<double>> rows{{1, 0, 0, 0},           {0, 1, 0, 0},
                                                {0, 0, 1, 0},           {-0.5, half_root, 0, 0},
                                                {half_root, 0.5, 0, 0}, {0, 0, -1, 27.413}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        one_chain +=
            fmt::format("REMARK 350   BIOMT{} {:3}{:10.6f}{:10.6f}{:10.6f}{:15.5f}\n", i % 3 + 1,
                        i / 3 + 1, rows[i][0], rows[i][1], rows[i][2], rows[i][3]);
    }
    for (const std::string_view line : split_lines(text)) {
        const bool is_atom =
            line.starts_with("ATOM") || line.starts_with("HETATM") || line.starts_with("TER");
        if (is_atom && line.size() > 21 && line[21] == 'A') one_chain += fmt::format("{}\n", line);
    }
    one_chain += "END\n";

    Report report;
    const Structure built = build_assembly(parse_pdb(one_chain, "a.pdb"), 1, report);

    const Structure expected = parse_pdb(text, "5vea.pdb");
    REQUIRE(built.names.size() == atoms);
    REQUIRE(expected.names.size() == atoms);
    CHECK(built.chain_ends == std::vector{atoms / 2, atoms});
    double farthest = 0;
    for (std::size_t i = 0; i < built.names.size(); ++i) {
        const AtomName &is = built.names[i], &was = expected.names[i];  // segments differ
        REQUIRE(is.residue + is.number + is.atom == was.residue + was.number + was.atom);
        REQUIRE(built.records[i].chain == expected.records[i].chain);
        REQUIRE(built.records[i].alternate == expected.records[i].alternate);
        farthest = std::max(farthest, (built.positions[i] - expected.positions[i]).norm());
    }
    CHECK(farthest < 0.01);  // Å; the file has three decimals
}

TEST_CASE("of products the last list acts first", "[prepare][assembly]") {
    StructureWriter writer;
    writer.atom("ALA", "A", 1, "CA", {1, 0, 0}, "C");
    Structure structure = writer.structure();
    // A quarter turn about z, and a step along x.
    const Mat3 quarter = (Mat3() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished();
    structure.operators = {{"turn", quarter, Vec3::Zero(), 0}, translation("step", 10)};
    structure.assemblies = {{"1", {{"A,", {{0}, {1}}}}}, {"2", {{"A,", {{1}, {0}}}}}};
    Report report;
    CHECK(build_assembly(structure, 1, report).positions[0] == Vec3(0, 11, 0));
    CHECK(build_assembly(structure, 2, report).positions[0] == Vec3(10, 1, 0));
    CHECK_THAT(report.to_text(), Contains("chain B: chain A by operator turnxstep"));
}

TEST_CASE("new chains take names that are free, at last of two letters", "[prepare][assembly]") {
    StructureWriter writer;
    writer.backbone("ALA", "A", 1, 0).end_chain();
    writer.backbone("ALA", "C", 1, 0).end_chain();
    std::vector<SymmetryOperator> operators;
    for (int i = 1; i <= 65; ++i) {  // the identity last
        operators.push_back(translation(std::to_string(i), 100.0 * (65 - i)));
    }
    Report report;
    const Structure built =
        build_assembly(with_assembly(writer.structure(), "A,", operators), 1, report);
    std::vector<std::string> chains;
    for (std::size_t i = 0; i < built.names.size(); i += 4) {
        chains.push_back(built.records[i].chain);
    }
    REQUIRE(chains.size() == 65);
    CHECK(chains[0] == "A");
    CHECK(built.positions[0] == Vec3(0, 0, 0));
    CHECK(chains[1] == "B");
    CHECK(chains[2] == "D");
    CHECK(chains[60] == "9");
    CHECK(chains[61] == "AA");
    CHECK(chains[64] == "AD");
    CHECK(built.chain_ends.size() == 65);
}

TEST_CASE("a ligand on one of three two-folds is there twice, of four copies",
          "[prepare][assembly]") {
    StructureWriter writer;
    writer.atom("LIG", "A", 1, "C1", {0.2, 0, 10}, "C", ' ', 0.5);
    const Structure structure = with_assembly(writer.structure(), "A,",
                                              {identity,
                                               {"2", diagonal(-1, -1, 1), Vec3::Zero(), 0},
                                               {"3", diagonal(1, -1, -1), Vec3::Zero(), 0},
                                               {"4", diagonal(-1, 1, -1), Vec3::Zero(), 0}});
    Report report;
    const Structure built = build_assembly(structure, 1, report);
    REQUIRE(built.names.size() == 2);
    CHECK(built.positions[1] == Vec3(0.2, 0, -10));
}

TEST_CASE("halves of a ligand that are a bond apart are both kept", "[prepare][assembly]") {
    StructureWriter writer;
    writer.atom("LIG", "A", 1, "C1", {0.77, 0, 0}, "C");
    writer.atom("LIG", "A", 1, "H1", {0.1, 0, 0}, "H");
    const Structure structure = with_assembly(
        writer.structure(), "A,", {identity, {"2", diagonal(-1, -1, 1), Vec3::Zero(), 0}});
    Report report;
    CHECK(build_assembly(structure, 1, report).names.size() == 4);
}

TEST_CASE("a residue of which little lies on the axis is kept once, with a warning",
          "[prepare][assembly]") {
    StructureWriter writer;
    writer.atom("LIG", "A", 1, "C1", {0.7, 0, 0}, "C");
    writer.atom("LIG", "A", 1, "C2", {2.2, 0, 0}, "C");
    writer.atom("LIG", "A", 1, "C3", {3.7, 0, 0}, "C");
    const Structure structure = with_assembly(
        writer.structure(), "A,", {identity, {"2", diagonal(-1, -1, 1), Vec3::Zero(), 0}});
    Report report;
    CHECK(build_assembly(structure, 1, report).names.size() == 3);
    REQUIRE(report.warnings().size() == 1);
    CHECK_THAT(report.warnings()[0], Contains("1 of its 3 heavy atoms"));
}

TEST_CASE("assemblies that are not there, or not of this world, are refused",
          "[prepare][assembly]") {
    StructureWriter writer;
    writer.atom("ALA", "A", 1, "CA", {1, 0, 0}, "C");
    Structure structure = writer.structure();
    Report report;
    const auto error = [&](int number) {
        return load_error_of([&] { build_assembly(structure, number, report); });
    };
    CHECK_THAT(error(1), Contains("small.pdb: no assembly 1: the file has none"));
    structure.operators = {{"7", diagonal(1, 1, -1), Vec3::Zero(), 41}, identity};
    structure.assemblies = {{"1", {{"A,", {{0}}}}}, {"PAU", {}}, {"3", {{"X,", {{1}}}}}};
    CHECK_THAT(error(2), Contains("no assembly 2 (only 1, PAU, 3)"));
    CHECK_THAT(error(1), Contains("small.pdb:41: operator 7 is not a rotation"));
    CHECK_THAT(error(3), Contains("the assembly has no atom"));
    CHECK_THAT(report.to_text(), Contains("chains of the assembly that are not in the file: X"));
}

TEST_CASE("what is chosen is of the assembly, and without one a warning names the option",
          "[prepare][assembly]") {
    PrepareSettings settings;
    settings.keeps_waters = true;
    Report report;
    CHECK(choose_atoms(parse_pdb(pdb, "w.pdb"), settings, report).names.size() == 9);
    REQUIRE(report.warnings().size() == 1);
    CHECK_THAT(report.warnings()[0],
               Contains("biological assembly 1 has 2 more copies of chains by symmetry, which were "
                        "not built; --assembly 1 builds them"));

    Report quiet;
    settings.assembly = 1;
    settings.without = {"B:103"};
    CHECK(choose_atoms(parse_pdb(pdb, "w.pdb"), settings, quiet).names.size() == 12);
    CHECK(quiet.warnings().empty());

    settings = {};
    StructureWriter writer;
    writer.backbone("ALA", "A", 1, 0);
    choose_atoms(with_assembly(writer.structure(), "A,", {identity}), settings, quiet);
    CHECK(quiet.warnings().empty());
}

TEST_CASE("of several models the one that is asked for is built", "[prepare][assembly]") {
    StructureWriter writer;
    writer.atom("ALA", "A", 1, "CA", {1, 0, 0}, "C");
    writer.model = 2;
    writer.atom("ALA", "A", 1, "CA", {2, 0, 0}, "C");
    PrepareSettings settings;
    settings.model = 2;
    settings.assembly = 1;
    Report report;
    const Structure built =
        choose_atoms(with_assembly(writer.structure(), "A,", {identity, translation("2", 10)}),
                     settings, report);
    REQUIRE(built.names.size() == 2);
    CHECK(built.positions[1] == Vec3(12, 0, 0));
}
