// Residues, chains and atoms get the names that the force field knows.
#include "prepare/atom_names.h"
#include "prepare/residue_names.h"
#include "prepare/segments.h"
#include "tests/prepare/small_system.h"
#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <map>
#include <string>

using namespace palpa;
using Catch::Contains;
using test::joined_names;
using test::load_error_of;
using test::small_force_field;
using test::StructureWriter;

namespace {

struct Named {
    Structure structure;
    GenerateSettings generate;
    Report report;
};

Named name_all(const Structure& structure, const PrepareSettings& settings = {}) {
    static const ForceField force_field = small_force_field();
    Named result;
    NamedResidues named = name_residues(force_field, structure, settings, result.report);
    named.problems.throw_if_any();
    result.generate =
        split_segments(force_field, named.structure, named.patches, settings, result.report);
    result.structure = name_atoms(force_field, named.structure, result.generate, result.report);
    return result;
}

// Without hydrogens, its side chain in the plane z = 0.
StructureWriter aspartate() {
    StructureWriter writer;
    writer.backbone("ASP", "A", 1, 0);
    writer.atom("ASP", "A", 1, "CB", {1.2, 2.3, 0}, "C");
    writer.atom("ASP", "A", 1, "CG", {2.6, 2.9, 0}, "C");
    writer.atom("ASP", "A", 1, "OD1", {3.6, 2.2, 0}, "O");
    writer.atom("ASP", "A", 1, "OD2", {2.7, 4.1, 0}, "O");
    return writer;
}

}  // namespace

TEST_CASE("ends, oxygens and hydrogens get CHARMM's names", "[prepare]") {
    StructureWriter writer;
    writer.backbone("ALA", "A", 1, 0);
    writer.atom("ALA", "A", 1, "CB", {1.2, 2.3, 0}, "C");
    writer.atom("ALA", "A", 1, "1HB", {2.2, 2.7, 0}, "H");
    writer.atom("ALA", "A", 1, "2HB", {0.7, 2.7, 0.9}, "H");
    writer.atom("ALA", "A", 1, "3HB", {0.7, 2.7, -0.9}, "H");
    writer.backbone("ALA", "A", 2, 3.8);
    writer.atom("ALA", "A", 2, "H", {3.8, 1, 0}, "H");
    writer.atom("ALA", "A", 2, "OXT", {7.3, 0.7, 0}, "O");
    const Named named = name_all(writer.structure());
    CHECK(joined_names(named.structure) == "N CA C O CB HB1 HB2 HB3 N CA C OT1 HN OT2 ");
    REQUIRE(named.generate.segments.size() == 1);
    CHECK(named.generate.segments[0].segment == "A");
    CHECK(named.generate.segments[0].first.empty());
}

TEST_CASE("the IC table names the two hydrogens of a carbon", "[prepare]") {
    // Across the plane of CA, CB, CG: HB1 is where the dihedral CG-CA-CB-HB1 is +119 degrees.
    for (const double side : {1.0, -1.0}) {
        StructureWriter writer = aspartate();
        writer.atom("ASP", "A", 1, "HB2", {0.7, 2.7, side * 0.9}, "H");
        writer.atom("ASP", "A", 1, "HB3", {0.7, 2.7, -side * 0.9}, "H");
        const Named named = name_all(writer.structure());
        std::map<std::string, double> z;
        for (std::size_t i = 0; i < named.structure.names.size(); ++i) {
            z[named.structure.names[i].atom] = named.structure.positions[i].z();
        }
        // By hand: looking from CA to CB (+y) with z up, CG is to the right; clockwise is down.
        INFO(side);
        CHECK(z.at("HB1") == Approx(-0.9));
        CHECK(z.at("HB2") == Approx(0.9));
    }
}

TEST_CASE("a gap is closed with neutral caps, TER with charged ends", "[prepare]") {
    StructureWriter gap;
    gap.backbone("ALA", "A", 1, 0).backbone("ALA", "A", 2, 3.8);
    gap.backbone("ALA", "A", 9, 30).backbone("ALA", "A", 10, 33.8);
    const Named named = name_all(gap.structure());
    REQUIRE(named.generate.segments.size() == 2);
    CHECK(named.generate.segments[0].last == "CT3");
    CHECK(named.generate.segments[1].segment == "A2");
    CHECK(named.generate.segments[1].first == "ACE");
    CHECK(named.generate.segments[1].last.empty());
    REQUIRE(named.report.warnings().size() == 1);
    CHECK_THAT(named.report.warnings()[0], Contains("gap between ALA A 2 and ALA A 9"));

    StructureWriter ended;
    ended.backbone("ALA", "A", 1, 0).backbone("ALA", "A", 2, 3.8).end_chain();
    ended.backbone("ALA", "A", 9, 30);
    const Named two = name_all(ended.structure());
    REQUIRE(two.generate.segments.size() == 2);
    CHECK(two.generate.segments[0].last.empty());
    CHECK(two.generate.segments[1].first.empty());
    CHECK(two.report.warnings().empty());
}

TEST_CASE("caps of other programs become patches of the residue beside them", "[prepare]") {
    StructureWriter writer;
    writer.atom("ACE", "", 1, "CH3", {-2.4, 0, 0}, "C");
    writer.atom("ACE", "", 1, "C", {-1.2, 0.5, 0}, "C");
    writer.atom("ACE", "", 1, "O", {-1.2, 1.7, 0}, "O");
    writer.backbone("ALA", "", 2, 0);
    writer.atom("ALA", "", 2, "CB", {1.2, 2.3, 0}, "C");
    writer.atom("NME", "", 3, "N", {3.8, 0, 0}, "N");
    writer.atom("NME", "", 3, "CH3", {5, 0.8, 0}, "C");
    writer.atom("NME", "", 3, "H", {3.8, -1, 0}, "H");
    const Named named = name_all(writer.structure());
    CHECK(joined_names(named.structure) == "CAY CY OY N CA C O CB NT CAT HNT ");
    REQUIRE(named.generate.segments.size() == 1);
    CHECK(named.generate.segments[0].first == "ACED");
    CHECK(named.generate.segments[0].last == "CT3");
}

TEST_CASE("hydrogens in the file, or a user, decide about protons", "[prepare]") {
    StructureWriter writer = aspartate();
    PrepareSettings asked;
    asked.protonation = {{{"A", "1"}, "ASPP"}};
    CHECK(name_all(writer.structure()).generate.patches.empty());
    CHECK(name_all(writer.structure(), asked).generate.patches.at(0).patch == "ASPP");

    writer.atom("ASP", "A", 1, "HD1", {4.5, 2.4, 0}, "H");
    const Named given = name_all(writer.structure());
    CHECK(given.generate.patches.at(0).patch == "ASPP");
    // CHARMM has the proton on OD2, so the oxygens change names.
    CHECK(joined_names(given.structure) == "N CA C OT1 CB CG OD2 OD1 HD2 ");

    asked.protonation = {{{"A", "1"}, "ASPX"}};
    CHECK_THAT(load_error_of([&] { name_all(writer.structure(), asked); }),
               Contains("no residue and no patch 'ASPX'; did you mean 'ASPP'?"));
    asked.protonation = {{{"A", "5"}, "ASPP"}};
    CHECK_THAT(load_error_of([&] { name_all(writer.structure(), asked); }),
               Contains("--protonation: no residue A:5 here"));
}

TEST_CASE("sulphurs are bonded nearest first", "[prepare]") {
    StructureWriter writer;
    int number = 1;
    for (const double x : {0.0, 2.05, 4.3}) {
        writer.atom("CYS", "A", number, "N", {x, 20.0 * number, 5}, "N");
        writer.atom("CYS", "A", number, "CA", {x, 20.0 * number, 3}, "C");
        writer.atom("CYS", "A", number, "C", {x, 20.0 * number, 7}, "C");
        writer.atom("CYS", "A", number, "O", {x, 20.0 * number, 8}, "O");
        writer.atom("CYS", "A", number, "SG", {x, 0, 0}, "S").end_chain();
        ++number;
    }
    const Named named = name_all(writer.structure());
    REQUIRE(named.generate.patches.size() == 1);
    CHECK(named.generate.patches[0].patch == "DISU");
    CHECK(named.generate.patches[0].residues[0].number == "1");
    CHECK(named.generate.patches[0].residues[1].number == "2");
    PrepareSettings none;
    none.finds_disulphides = false;
    CHECK(name_all(writer.structure(), none).generate.patches.empty());
}

TEST_CASE("ligands, waters and ions get segments of their own", "[prepare]") {
    StructureWriter writer;
    writer.backbone("ALA", "A", 1, 0).end_chain();
    for (const int number : {101, 102}) {
        writer.atom("LIG", "A", number, "C1", {20.0 + number, 0, 0}, "C");
        writer.atom("LIG", "A", number, "C2", {21.5 + number, 0, 0}, "C");
        writer.atom("LIG", "A", number, "C3", {23.0 + number, 0, 0}, "C");
    }
    writer.atom("HOH", "A", 301, "O", {9, 9, 9}, "O").atom("HOH", "A", 302, "O", {9, 9, 5}, "O");
    writer.atom("NA", "A", 303, "NA", {9, 0, 9}, "NA");
    const Named named = name_all(writer.structure());
    std::string segments;
    for (const SegmentSettings& segment : named.generate.segments)
        segments += segment.segment + " ";
    CHECK(segments == "A LIG LIG2 WA IA ");
    CHECK(named.structure.names.back().atom == "SOD");
    CHECK(named.structure.names[10].atom == "OH2");
}

TEST_CASE("segments of many equal ligands have names that fit a PDB file", "[prepare]") {
    constexpr int ligands = 120;
    StructureWriter writer;
    for (int i = 1; i <= ligands; ++i) {
        const double x = 10.0 * i;
        for (const int atom : {1, 2, 3})
            writer.atom("LIG", "A", i, "C" + std::to_string(atom), {x + 1.5 * atom, 0, 0}, "C");
    }

    const Named named = name_all(writer.structure());

    std::map<std::string, int> atoms;
    for (const AtomName& name : named.structure.names) ++atoms[name.segment];
    CHECK(atoms.size() == ligands);
    for (const auto& [segment, count] : atoms) {
        INFO(segment);
        CHECK(segment.size() <= 4);
        CHECK(count == 3);
    }
    CHECK(atoms.contains("LIG9"));
    CHECK(atoms.contains("LI10"));
    CHECK(atoms.contains("L120"));
}

TEST_CASE("all that keeps a structure from becoming a system is in one message", "[prepare]") {
    StructureWriter writer;
    writer.backbone("ALA", "A", 1, 0);
    writer.atom("QQQ", "B", 1, "X1", {9, 9, 9}, "C");
    writer.atom("CSO", "B", 2, "SG", {9, 9, 19}, "S");
    const std::string unknown = load_error_of([&] { name_all(writer.structure()); });
    CHECK_THAT(unknown, Contains("'QQQ' (B:1; 1 atoms)") && Contains("--without QQQ"));
    CHECK_THAT(unknown, Contains("--as CSO=CYS"));

    StructureWriter alphas;
    alphas.atom("ALA", "A", 1, "CA", {0, 0, 0}, "C").atom("ALA", "A", 2, "CA", {3.8, 0, 0}, "C");
    CHECK_THAT(load_error_of([&] { name_all(alphas.structure()); }),
               Contains("alpha-carbons only"));

    StructureWriter halves;
    halves.atom("LIG", "A", 1, "C1", {0, 0, 0}, "C").end_chain();
    halves.atom("LIG", "B", 1, "C1", {3, 0, 0}, "C");
    CHECK_THAT(load_error_of([&] { name_all(halves.structure()); }),
               Contains("LIG A:1 and B:1 have each 1 of its 3 heavy atoms (C2 C3 missing)") &&
                   Contains("--without LIG"));

    StructureWriter twice;
    twice.backbone("ALA", "A", 1, 0).backbone("ASP", "A", 1, 3.8);
    CHECK_THAT(load_error_of([&] { name_all(twice.structure()); }),
               Contains("ASP A 1 has the same number as ALA (line 1)"));

    StructureWriter stranger;
    stranger.backbone("ALA", "A", 1, 0).atom("ALA", "A", 1, "XG", {1.2, 2.3, 0}, "S");
    CHECK_THAT(load_error_of([&] { name_all(stranger.structure()); }),
               Contains("ALA A 1 has an atom 'XG' that is not in its topology"));
}

TEST_CASE("elements that contradict the names are put right and told", "[prepare]") {
    StructureWriter writer;
    writer.atom("ALA", "A", 1, "N", {0, 0, 0}, "C");
    writer.atom("ALA", "A", 1, "CA", {1.2, 0.8, 0}, "CA");
    writer.atom("ALA", "A", 1, "C", {2.5, 0, 0}, "C");
    const Named named = name_all(writer.structure());
    CHECK(named.structure.records[1].element == "C");
    REQUIRE_FALSE(named.report.warnings().empty());
    CHECK_THAT(named.report.warnings()[0], Contains("2 atoms have an element"));
}
