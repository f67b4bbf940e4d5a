// Biological assemblies as PDB and mmCIF files tell of them.
#include "formats/mmcif.h"
#include "formats/pdb.h"
#include "tests/support/load_error_of.h"
#include "tests/support/replaced.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;
using test::replaced;

namespace {

// Typed by hand after the format's description 3.3: prose, a list over two lines, a two-fold.
const std::string pdb = R"(HEADER    TYPED BY HAND
REMARK 350
REMARK 350 COORDINATES FOR A COMPLETE MULTIMER REPRESENTING THE KNOWN
REMARK 350 BIOMOLECULE: 1
REMARK 350 AUTHOR DETERMINED BIOLOGICAL UNIT: DIMERIC
REMARK 350 APPLY THE FOLLOWING TO CHAINS: A,
REMARK 350                    AND CHAINS: B
REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000
REMARK 350   BIOMT1   2 -0.500000  0.866025  0.000000        0.00000
REMARK 350   BIOMT2   2  0.866025  0.500000  0.000000        0.00000
REMARK 350   BIOMT3   2  0.000000  0.000000 -1.000000       27.41300
REMARK 350 APPLY THE FOLLOWING TO CHAINS: C
REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000
REMARK 350 BIOMOLECULE: 2
REMARK 350 APPLY THE FOLLOWING TO CHAINS: A
REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000
ATOM      1  CA  ALA A   1      10.000   0.000   5.000  1.00 10.50           C
END
)";

// The same in the archive's words; the operators behind the assemblies.
const std::string cif = R"(data_HAND
loop_
_pdbx_struct_assembly_gen.assembly_id
_pdbx_struct_assembly_gen.oper_expression
_pdbx_struct_assembly_gen.asym_id_list
1 1,2 A,B
1 1   C
2 1   A
loop_
_pdbx_struct_oper_list.id
_pdbx_struct_oper_list.type
_pdbx_struct_oper_list.name
_pdbx_struct_oper_list.matrix[1][1]
_pdbx_struct_oper_list.matrix[1][2]
_pdbx_struct_oper_list.matrix[1][3]
_pdbx_struct_oper_list.vector[1]
_pdbx_struct_oper_list.matrix[2][1]
_pdbx_struct_oper_list.matrix[2][2]
_pdbx_struct_oper_list.matrix[2][3]
_pdbx_struct_oper_list.vector[2]
_pdbx_struct_oper_list.matrix[3][1]
_pdbx_struct_oper_list.matrix[3][2]
_pdbx_struct_oper_list.matrix[3][3]
_pdbx_struct_oper_list.vector[3]
1 'identity operation' 1_555 1.0 0.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 1.0 0.0
2 'crystal symmetry operation' 10_555 -0.5 0.866025 0.0 0.0 0.866025 0.5 0.0 0.0 0.0 0.0 -1.0 27.413
_atom_site.Cartn_x 10
_atom_site.Cartn_y 0
_atom_site.Cartn_z 5
_atom_site.auth_seq_id 1
_atom_site.label_comp_id ALA
_atom_site.label_asym_id A
_atom_site.label_atom_id CA
)";

std::string pdb_error(const std::string& from, const std::string& to) {
    return load_error_of([&] { parse_pdb(replaced(pdb, from, to), "w.pdb"); });
}

std::string cif_error(const std::string& from, const std::string& to) {
    return load_error_of([&] { parse_mmcif(replaced(cif, from, to), "w.cif"); });
}

Structure with_expression(const std::string& expression) {
    return parse_mmcif(replaced(cif, "1 1,2 A,B", "1 '" + expression + "' A,B"), "w.cif");
}

// The matrix and vector that each index of a part stands for.
void check_part(const Structure& structure, const AssemblyPart& part, const std::string& chains,
                std::size_t operators) {
    CHECK(part.chains == chains);
    REQUIRE(part.operators.size() == 1);
    REQUIRE(part.operators[0].size() == operators);
    const SymmetryOperator& first = structure.operators[part.operators[0][0]];
    CHECK(first.rotation == Mat3::Identity());
    CHECK(first.translation == Vec3::Zero());
    if (operators < 2) return;
    const SymmetryOperator& second = structure.operators[part.operators[0][1]];
    CHECK(second.name == "2");
    // By hand: the rows of the matrix.
    CHECK(second.rotation * Vec3(1, 0, 0) == Vec3(-0.5, 0.866025, 0));
    CHECK(second.rotation * Vec3(0, 1, 0) == Vec3(0.866025, 0.5, 0));
    CHECK(second.rotation * Vec3(0, 0, 1) == Vec3(0, 0, -1));
    CHECK(second.translation == Vec3(0, 0, 27.413));
}

}  // namespace

TEST_CASE("PDB and mmCIF tell the same assemblies", "[formats][assembly]") {
    for (const Structure& structure : {parse_pdb(pdb, "w.pdb"), parse_mmcif(cif, "w.cif")}) {
        INFO(structure.file);
        REQUIRE(structure.assemblies.size() == 2);
        CHECK(structure.assemblies[0].name == "1");
        REQUIRE(structure.assemblies[0].parts.size() == 2);
        check_part(structure, structure.assemblies[0].parts[0], "A,B,", 2);
        check_part(structure, structure.assemblies[0].parts[1], "C,", 1);
        CHECK(structure.assemblies[1].name == "2");
        REQUIRE(structure.assemblies[1].parts.size() == 1);
        check_part(structure, structure.assemblies[1].parts[0], "A,", 1);
    }
}

TEST_CASE("an assembly of one row need not be a loop", "[formats][assembly]") {
    const std::size_t begin = cif.find("loop_"), end = cif.find("loop_", begin + 1);
    const std::string pairs =
        "_pdbx_struct_assembly_gen.assembly_id 7\n"
        "_pdbx_struct_assembly_gen.oper_expression 1,2\n"
        "_pdbx_struct_assembly_gen.asym_id_list A,B\n";

    const Structure structure =
        parse_mmcif(cif.substr(0, begin) + pairs + cif.substr(end), "w.cif");

    REQUIRE(structure.assemblies.size() == 1);
    CHECK(structure.assemblies[0].name == "7");
    REQUIRE(structure.assemblies[0].parts.size() == 1);
    check_part(structure, structure.assemblies[0].parts[0], "A,B,", 2);
}

TEST_CASE("a chain without a name, and an assembly without a number", "[formats][assembly]") {
    std::string text = replaced(pdb, "CHAINS: C", "CHAINS: NULL");
    text = replaced(text, "REMARK 350 BIOMOLECULE: 1\n", "");
    const Structure structure = parse_pdb(text, "w.pdb");
    REQUIRE(structure.assemblies.size() == 2);
    CHECK(structure.assemblies[0].name == "1");
    CHECK(structure.assemblies[0].parts[1].chains.empty());
}

TEST_CASE("lists and products of operators in every form", "[formats][assembly]") {
    using Lists = std::vector<std::vector<std::uint32_t>>;
    const auto lists = [](const std::string& expression) {
        return with_expression(expression).assemblies[0].parts[0].operators;
    };
    CHECK(lists("2") == Lists{{1}});
    CHECK(lists("1-2") == Lists{{0, 1}});
    CHECK(lists("(1)") == Lists{{0}});
    CHECK(lists("(1-2)(2,1)") == Lists{{0, 1}, {1, 0}});
    CHECK(lists("(2) (1, 2)(1-1)") == Lists{{1}, {0, 1}, {0}});
    const Structure named = parse_mmcif(
        replaced(replaced(cif, "1 1,2 A,B", "1 (P)(1) A,B"), "\n2 'cry", "\nP 'cry"), "w.cif");
    CHECK(named.assemblies[0].parts[0].operators == Lists{{1}, {0}});
}

TEST_CASE("a broken REMARK 350 is refused with its line", "[formats][assembly]") {
    CHECK(pdb_error("-0.500000  0.866025", "-0.5x0000  0.866025") ==
          "w.pdb:11: '-0.5x0000' is not a number");
    CHECK_THAT(pdb_error("     27.41300", "1000000.0000"),
               Contains("w.pdb:13: '1000000.0000' is not a translation"));
    CHECK_THAT(pdb_error("BIOMT2   2", "BIOMT3   2"),
               Contains("w.pdb:12: 'BIOMT3 2'; expected BIOMT2 2"));
    CHECK_THAT(pdb_error("BIOMT2   2", "BIOMT2   3"),
               Contains("w.pdb:12: 'BIOMT2 3'; expected BIOMT2 2"));
    CHECK_THAT(pdb_error("  0.000000 -1.000000       27.41300", " 0.0 -1.0"),
               Contains("w.pdb:13: 5 words after REMARK 350; expected 6"));
    CHECK_THAT(
        pdb_error("REMARK 350   BIOMT3   2  0.000000  0.000000 -1.000000       27.41300\n", ""),
        Contains("w.pdb:11: operator 2 has no row BIOMT3"));
    CHECK_THAT(pdb_error("REMARK 350 APPLY THE FOLLOWING TO CHAINS: C",
                         "REMARK 350 APPLY THE FOLLOWING TO CHAINS: C\n"
                         "REMARK 350 APPLY THE FOLLOWING TO CHAINS: C"),
               Contains("w.pdb:14: chains without an operator"));
    CHECK_THAT(pdb_error("REMARK 350 APPLY THE FOLLOWING TO CHAINS: A,", "REMARK 350"),
               Contains("w.pdb:7: AND CHAINS without APPLY"));
    CHECK_THAT(pdb_error("BIOMOLECULE: 2", "BIOMOLECULE: 1"),
               Contains("w.pdb:18: biomolecule 1 is repeated"));
}

TEST_CASE("broken assemblies of an mmCIF file are refused with their lines",
          "[formats][assembly]") {
    CHECK_THAT(cif_error("1 1,2 A,B", "1 1,3 A,B"), Contains("w.cif:6:3: no operator '3'"));
    CHECK_THAT(cif_error("1 1,2 A,B", "1 1-60 A,B"), Contains("w.cif:6:3: no operator '3'"));
    CHECK_THAT(cif_error("1 1,2 A,B", "1 2-1 A,B"), Contains("'2-1' runs backwards"));
    CHECK_THAT(cif_error("1 1,2 A,B", "1 (1,2 A,B"), Contains("'(1,2' is not an expression"));
    CHECK_THAT(cif_error("1 1,2 A,B", "1 (1)2 A,B"), Contains("'(1)2' is not an expression"));
    CHECK_THAT(cif_error("1 1,2 A,B", "1 ? A,B"),
               Contains("w.cif:6:3: no value of _pdbx_struct_assembly_gen.oper_expression"));
    CHECK_THAT(cif_error("0.866025 0.0 0.0 0.866025", "0.866025 0.0 0.0 x"),
               Contains("'x' in _pdbx_struct_oper_list.matrix[2][1] is not a number"));
    CHECK_THAT(cif_error("-1.0 27.413", "-1.0 ?"), Contains("w.cif:26:"));
    CHECK_THAT(cif_error("-1.0 27.413", "-1.0"), Contains("ends after 14 of 15 values"));
    CHECK_THAT(cif_error("2 'cry", "1 'cry"), Contains("w.cif:26:1: operator 1 again"));
    CHECK_THAT(cif_error("_pdbx_struct_oper_list.vector[3]", "_pdbx_struct_oper_list.w"),
               Contains("no value of _pdbx_struct_oper_list.vector[3]"));
}

TEST_CASE("expressions that would explode are refused", "[formats][assembly]") {
    const std::string ten = "(1,2,1,2,1,2,1,2,1,2)";
    CHECK(with_expression(ten + ten + ten).assemblies[0].parts[0].operators.size() == 3);
    const auto error = [](const std::string& expression) {
        return load_error_of([&] { with_expression(expression); });
    };
    CHECK_THAT(error(ten + ten + ten + "(1,2)"),
               Contains("stands for too many operators; expected at most 1000"));
    CHECK_THAT(error("(1)(1)(1)(1)(1)(1)(1)(1)(1)"), Contains("of 8 lists"));
    std::string long_list = "1";
    for (int i = 0; i < 1000; ++i) long_list += ",2";
    CHECK_THAT(error(long_list), Contains("too many operators; expected at most 1000"));
}
