#include "charmm/assign_solvation.h"
#include "charmm/cut_topology.h"
#include "charmm/solvation_reader.h"
#include "core/files.h"
#include "core/text.h"
#include "formats/psf.h"
#include "tests/support/force_field_of.h"
#include "tests/support/load_error_of.h"
#include "tests/support/native_case.h"
#include "tests/support/paths.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

const std::string head =
    "type,volume_A3,dG_ref,dG_free,dH_ref,dCp_ref,lambda_A,R_min_half_A,source\n";

SolvationTable table_of(const std::string& rows) {
    return parse_solvation_table(head + rows, "t.csv");
}

std::string error_of(const std::string& text) {
    return load_error_of([&] { (void)parse_solvation_table(text, "t.csv"); });
}

constexpr const char* small_field = R"(ATOMS
MASS -1 CX 12.0 C
MASS -1 CY9 12.0 C
MASS -1 HX 1.0 H
MASS -1 OT 15.9994 O
MASS -1 HT 1.008 H
NONBONDED
CX 0.0 -0.1 2.11 0.0 -0.01 1.9
CY9 0.0 -0.1 2.2
HX 0.0 -0.02 1.3
OT 0.0 -0.1521 1.7682
HT 0.0 -0.046 0.2245
END
)";

Connectivity atoms_of(const std::vector<std::array<std::string, 2>>& residues_and_types) {
    const ForceField field = test::force_field_of(small_field, "a.prm");
    Connectivity atoms;
    atoms.file = "a.psf";
    for (const auto& [residue, type] : residues_and_types) {
        atoms.names.push_back({"A", residue, "1", type + std::to_string(atoms.names.size() + 1)});
        atoms.type.push_back(type);
        atoms.charge.push_back(0);
        atoms.mass.push_back(field.types.at(type).mass);
        atoms.lines.push_back(atoms.names.size() + 10);
    }
    return atoms;
}

}  // namespace

TEST_CASE("a solvation table is read by its types", "[charmm][solvation]") {
    const SolvationTable table = table_of(
        "# a note\n\nCX,11.5,-0.187,-0.2,0.876,0,3.5,2.0,\"one, two\"\r\n"
        "ny , 0 , -1 , -1 , 0 , 0 , 6.0 , 1.85 , ASSIGNED: as N\n");
    REQUIRE(table.types.size() == 2);
    const SolvationRow& row = table.types.at("CX");
    CHECK(row.volume == 11.5);
    CHECK(row.dg_ref == -0.187);
    CHECK(row.dg_free == -0.2);
    CHECK(row.lambda == 3.5);
    CHECK(row.source == "one, two");
    CHECK_FALSE(row.is_assigned);
    CHECK(row.place.line == 4);
    CHECK(table.types.at("NY").is_assigned);
    CHECK(table.types.at("NY").lambda == 6);
}

TEST_CASE("what is wrong with a solvation table is told with its line", "[charmm][solvation]") {
    CHECK(error_of("") == "t.csv: the table has no atom types; expected one line for each");
    CHECK_THAT(error_of("type,volume\n"), Contains("t.csv:1: 'type,volume' is not the header"));
    CHECK_THAT(error_of(head), Contains("no atom type"));
    CHECK_THAT(error_of(head + "C,1,2,3\n"), Contains("t.csv:2: 4 fields; expected 9"));
    CHECK_THAT(error_of(head + "# x\nC,x,0,0,0,0,3.5,2,a\n"),
               Contains("t.csv:3: 'x' is not a volume; expected a number, in Å^3"));
    CHECK_THAT(error_of(head + "C,nan,0,0,0,0,3.5,2,a\n"), Contains("is not a volume"));
    CHECK_THAT(error_of(head + "C,1,0,0,0,0,,2,a\n"), Contains("'' is not a lambda"));
    CHECK_THAT(error_of(head + "C,1,0,0,0,0,0,2,a\n"), Contains("lambda is 0 Å"));
    CHECK_THAT(error_of(head + "C,-1,0,0,0,0,3.5,2,a\n"), Contains("the volume is -1 Å^3"));
    CHECK_THAT(error_of(head + "C,1,0,0,0,0,3.5,-2,a\n"), Contains("the radius is -2 Å"));
    CHECK_THAT(error_of(head + "C,1e5,0,0,0,0,3.5,2,a\n"), Contains("the volume is 100000 Å^3"));
    CHECK_THAT(error_of(head + "C,1,0,-1e5,0,0,3.5,2,a\n"),
               Contains("the energy is -100000 kcal/mol"));
    CHECK_THAT(error_of(head + "C,1,0,0,0,0,1e4,2,a\n"), Contains("lambda is 10000 Å"));
    CHECK_THAT(error_of(head + "C,1,0,0,0,0,3.5,1e3,a\n"), Contains("the radius is 1000 Å"));
    CHECK_THAT(error_of(head + "C,1,0,0,0,0,3.5,2,a,b\n"), Contains("'a,b' is not a valid source"));
    CHECK_THAT(error_of(head + "C,1,0,0,0,0,3.5,2,\"a\n"), Contains("is not a valid source"));
    CHECK_THAT(error_of(head + ",1,0,0,0,0,3.5,2,a\n"), Contains("'' is not an atom type"));
    CHECK_THAT(error_of(head + "C,1,0,0,0,0,3.5,2,a\nc,1,0,0,0,0,3.5,2,a\n"),
               Contains("t.csv:3: type C is repeated, first on line 2"));
}

TEST_CASE("the program's table is EEF1-SB's", "[charmm][solvation]") {
    const SolvationTable& table = eef1sb_table();
    const auto assigned = std::ranges::count_if(
        table.types, [](const auto& entry) { return entry.second.is_assigned; });
    CHECK(table.types.size() == 67);
    CHECK(assigned == 34);  // 10 of TL-3, 24 beside
    // As the authors and PLUMED's source print them.
    CHECK(table.types.at("NH3").volume == 18.817);
    CHECK(table.types.at("NH3").dg_ref == -20);
    CHECK(table.types.at("NH3").lambda == 6);
    CHECK(table.types.at("CPH1").dg_free == 0.08);
    CHECK(table.types.at("CPH1").dg_ref == 0.057);
    CHECK(table.types.at("CG331").volume == table.types.at("CT3").volume);
    // Nothing of either is published.
    for (const char* const type : {"SS", "SOD", "CLA", "OT", "HC"})
        CHECK(!table.types.contains(type));
}

TEST_CASE("the program's table has the reference's numbers", "[charmm][solvation]") {
    const auto file = test::find_shared_data("reference/solvent/eef1sb_parameters.csv");
    if (!file) return;
    const SolvationTable theirs = parse_solvation_table(read_text_file(*file), "reference.csv");
    const SolvationTable& ours = eef1sb_table();
    REQUIRE(ours.types.size() == theirs.types.size());
    for (const auto& [type, row] : theirs.types) {
        INFO(type);
        const SolvationRow& own = ours.types.at(type);
        CHECK(own.volume == row.volume);
        CHECK(own.dg_ref == row.dg_ref);
        CHECK(own.dg_free == row.dg_free);
        CHECK(own.lambda == row.lambda);
        CHECK(own.is_assigned == row.is_assigned);
    }
}

TEST_CASE("radii are those of the force field, which the table agrees with",
          "[charmm][solvation]") {
    const auto folder = test::find_shared_data("data/charmm");
    if (!folder) return;
    const ForceField field =
        test::read_charmm(*folder, {"par_all36m_prot.prm", "par_all36_cgenff.prm"});
    std::size_t compared = 0;
    for (const std::string_view line : split_lines(eef1sb_csv())) {
        if (line.empty() || line.front() == '#' || line.starts_with("type")) continue;
        std::vector<std::string> fields(1);
        for (const char c : line) {
            if (c == ',') {
                fields.emplace_back();
            } else {
                fields.back() += c;
            }
        }
        INFO(fields[0]);
        CHECK(field.nonbonded.at(fields[0]).half_rmin == find_real(fields[7]));
        ++compared;
    }
    CHECK(compared == 67);
}

TEST_CASE("atoms have their types' numbers, hydrogens none", "[charmm][solvation]") {
    const ForceField field = test::force_field_of(small_field, "a.prm");
    const SolvationTable table = table_of("CX,11.5,-0.187,-0.2,0,0,3.5,2.0,a\n");
    const Connectivity atoms = atoms_of({{"LIG", "CX"}, {"LIG", "HX"}, {"LIG", "CX"}});
    const Solvation solvation = assign_solvation(atoms, field, table);
    CHECK(solvation.volume == std::vector<double>{11.5, 0, 11.5});
    CHECK(solvation.dg_ref == std::vector<double>{-0.187, 0, -0.187});
    CHECK(solvation.dg_free == std::vector<double>{-0.2, 0, -0.2});
    CHECK(solvation.lambda[0] == 3.5);
    CHECK(solvation.lambda[1] > 0);
    CHECK(solvation.radius ==
          std::vector<double>{2.11, 1.3, 2.11});  // not the table's 2.0, nor 1-4's

    AtomTable same;
    same.type_names = {"HX", "CX"};
    same.type = {1, 0, 1};
    same.names = atoms.names;
    same.mass = atoms.mass;
    same.half_rmin = {2.11, 1.3, 2.11};
    const Solvation again = assign_solvation(same, table, {}, {"a.toml"});
    CHECK(again.volume == solvation.volume);
    CHECK(again.dg_ref == solvation.dg_ref);
    CHECK(again.radius == solvation.radius);
}

TEST_CASE("radii of another force field than the table's are named", "[charmm][solvation]") {
    const ForceField field = test::force_field_of(small_field, "a.prm");
    const Connectivity atoms = atoms_of({{"LIG", "CX"}, {"LIG", "HX"}, {"LIG", "CX"}});
    const auto others = [&](const std::string& rows) {
        const SolvationTable table = table_of(rows);
        return find_other_radii(atoms, assign_solvation(atoms, field, table), table);
    };
    CHECK(others("CX,11.5,-0.187,-0.2,0,0,3.5,2.0,a\n") ==
          std::vector<std::string>{"CX (2.11 Å, not 2 Å)"});
    CHECK(others("CX,11.5,-0.187,-0.2,0,0,3.5,2.1,a\n").empty());
    CHECK(others("CX,11.5,-0.187,-0.2,0,0,3.5,2.0,ASSIGNED: as CT1\n").empty());
    // CHARMM36's.
    const Connectivity all = read_psf(test::in_project("scenes/hiv/system.psf"));
    const ForceField charmm36 = test::force_field_of(
        read_text_file(test::in_project("scenes/hiv/system.prm")), "system.prm");
    CHECK(find_other_radii(all, assign_solvation(all, charmm36, eef1sb_table()), eef1sb_table())
              .empty());
}

TEST_CASE("a heavy type without a row is refused with its name", "[charmm][solvation]") {
    const ForceField field = test::force_field_of(small_field, "a.prm");
    const SolvationTable table = table_of("CX,11.5,-0.187,-0.2,0,0,3.5,2.0,a\n");
    const Connectivity atoms =
        atoms_of({{"LIG", "CX"}, {"LIG", "CY9"}, {"LIG", "CY9"}, {"LIG", "OT"}});
    const std::string error = load_error_of([&] { (void)assign_solvation(atoms, field, table); });
    CHECK_THAT(error, Contains("a.psf:12: no solvation parameters in t.csv for type CY9 of A LIG 1 "
                               "CY92"));
    CHECK_THAT(error, Contains("type OT of A LIG 1 OT4"));
    CHECK_THAT(error, !Contains("CY93"));  // each type once
    CHECK_THAT(error, Contains("--solvent none"));
    CHECK(find_uncovered_types(atoms, table) ==
          std::vector<std::string>{"CY9 (A LIG 1 CY92)", "OT (A LIG 1 OT4)"});
}

TEST_CASE("structural waters count for nothing, and nothing else may", "[charmm][solvation]") {
    const ForceField field = test::force_field_of(small_field, "a.prm");
    const SolvationTable table = table_of("CX,11.5,-0.187,-0.2,0,0,3.5,2.0,a\n");
    const Connectivity atoms =
        atoms_of({{"TIP3", "OT"}, {"TIP3", "HT"}, {"TIP3", "HT"}, {"LIG", "CX"}, {"LIG", "CY9"}});
    CHECK(find_water_atoms(atoms.names, atoms.mass) == std::vector<std::uint8_t>{1, 1, 1, 0, 0});
    const std::vector<std::uint8_t> all(atoms.names.size(), 1);
    const std::string error =
        load_error_of([&] { (void)assign_solvation(atoms, field, table, all); });
    CHECK_THAT(error, Contains("type CY9") && !Contains("type OT"));
    CHECK_THAT(load_error_of([&] { (void)assign_solvation(atoms, field, table); }),
               Contains("type OT of A TIP3 1 OT1"));

    const Connectivity covered =
        atoms_of({{"TIP3", "OT"}, {"TIP3", "HT"}, {"TIP3", "HT"}, {"LIG", "CX"}});
    const Solvation solvation =
        assign_solvation(covered, field, table, std::vector<std::uint8_t>{1, 1, 1, 1});
    CHECK(solvation.volume == std::vector<double>{0, 0, 0, 11.5});
    CHECK(solvation.dg_ref[0] == 0);
    CHECK(solvation.radius[0] == 1.7682);
}

TEST_CASE("the types of TL-3 are there by our assignment, and listed", "[charmm][solvation]") {
    const Connectivity all = read_psf(test::in_project("scenes/hiv/system.psf"));
    Connectivity ligand;
    (void)append_segment(all, "TL3C", ligand);
    CHECK(find_uncovered_types(all, eef1sb_table()).empty());
    const std::vector<std::string> assigned = find_assigned_types(ligand, eef1sb_table());
    CHECK(assigned.size() == 10);
    CHECK(std::ranges::count(assigned, "CG331: as CT3 (CH3); chosen for TL-3") == 1);
    CHECK(find_assigned_types(all, eef1sb_table()).size() == 10);  // the protein has published ones
    // What TL-3 gains from water when alone in many small molecules: solvent.md's table by hand.
    const double by_hand = 24 * 0.057 + 10 * -0.187 + 4 * 0.372 + 6 * 1.089 + 6 * -5.95 +
                           6 * -5.33 + 2 * -2.9 + 2 * -5.92;
    ForceField field = test::force_field_of(
        read_text_file(test::in_project("scenes/hiv/system.prm")), "system.prm");
    const Solvation solvation = assign_solvation(ligand, field, eef1sb_table());
    double sum = 0;
    for (const double dg : solvation.dg_ref) sum += dg;
    CHECK(sum == Approx(by_hand).epsilon(1e-12));
}

TEST_CASE("a cut topology takes its atoms' solvation along", "[charmm][solvation]") {
    Topology whole;
    whole.charge = {0, 0, 0};
    whole.type = {0, 0, 0};
    whole.exclusions = build_exclusions({}, 3);
    const std::vector<std::uint32_t> atoms{0, 2};
    CHECK_FALSE(cut_topology(whole, atoms).solvation);
    whole.solvation = Solvation{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 15}};
    const Topology cut = cut_topology(whole, atoms);
    REQUIRE(cut.solvation);
    CHECK(cut.solvation->volume == std::vector<double>{1, 3});
    CHECK(cut.solvation->dg_ref == std::vector<double>{4, 6});
    CHECK(cut.solvation->dg_free == std::vector<double>{7, 9});
    CHECK(cut.solvation->lambda == std::vector<double>{10, 12});
    CHECK(cut.solvation->radius == std::vector<double>{13, 15});
}
