// Names of the PDB become CHARMM's, by tables and by bonds, and what is bonded gets its patch.
#include "prepare/residue_links.h"

#include "molecule/components.h"
#include "prepare/atom_names.h"
#include "prepare/match_by_bonds.h"
#include "prepare/residue_names.h"
#include "prepare/segments.h"
#include "tests/prepare/small_system.h"
#include "tests/support/load_error_of.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;
using test::force_field_of;
using test::joined_names;
using test::load_error_of;
using test::StructureWriter;

namespace {

// Of each kind of residue what links and names need, without hydrogens.
constexpr std::string_view linked_topology = R"(read rtf
MASS -1 C 12.0 C
MASS -1 N 14.0 N
MASS -1 O 16.0 O
MASS -1 P 31.0 P
MASS -1 FE 55.8 FE
MASS -1 SO 23.0 NA
AUTO ANGLES DIHE PATCH
DEFA FIRS NONE LAST NONE
RESI ASN 0.0
ATOM N N 0.0
ATOM CA C 0.0
ATOM CB C 0.0
ATOM CG C 0.0
ATOM OD1 O 0.0
ATOM ND2 N 0.0
ATOM C C 0.0
ATOM O O 0.0
BOND N CA CA CB CB CG CG OD1 CG ND2 CA C C O C +N
RESI BGLCNA 0.0
ATOM C1 C 0.0
ATOM C2 C 0.0
ATOM N N 0.0
ATOM C4 C 0.0
ATOM O4 O 0.0
ATOM O1 O 0.0
BOND C1 C2 C2 N C2 C4 C4 O4 C1 O1
RESI AMAN 0.0
ATOM C1 C 0.0
ATOM O1 O 0.0
ATOM O6 O 0.0
BOND C1 O1 C1 O6
RESI CYT 0.0
ATOM P P 0.0
ATOM O1P O 0.0
ATOM O5' O 0.0
ATOM C5' C 0.0
ATOM C4' C 0.0
ATOM C3' C 0.0
ATOM O3' O 0.0
ATOM C2' C 0.0
ATOM O2' O 0.0
ATOM C1' C 0.0
BOND P O1P P O5' O5' C5' C5' C4' C4' C3' C3' O3' C3' C2' C2' O2' C2' C1' O3' +P
RESI CA 0.0
ATOM C1 C 0.0
ATOM C2 C 0.0
ATOM C3 C 0.0
ATOM C4 C 0.0
BOND C1 C2 C2 C3 C3 C4
RESI SOD 0.0
ATOM SOD SO 0.0
PRES NGLB 0.0
DELE ATOM 2O1
BOND 1ND2 2C1
PRES 14BB 0.0
DELE ATOM 2O1
BOND 1O4 2C1
PRES 14AB 0.0
DELE ATOM 2O1
BOND 1O4 2C1
PRES 5TER 0.0
DELETE ATOM P
DELETE ATOM O1P
PRES 5PHO 0.0
ATOM O5T O 0.0
BOND P O5T
PRES 3TER 0.0
ATOM O3' O 0.0
PRES DEO5 0.0
DELETE ATOM O2'
PRES DEOX 0.0
DELETE ATOM O2'
end
)";

const ForceField& linked_force_field() {
    static const ForceField force_field = force_field_of(linked_topology, "linked.str");
    return force_field;
}

void add_sugar(StructureWriter& writer, const std::string& name, int number, double at) {
    writer.atom(name, "A", number, "C1", {at, 0, 0}, "C");
    writer.atom(name, "A", number, "C2", {at + 1.5, 0, 0}, "C");
    writer.atom(name, "A", number, "N2", {at + 1.5, 1.45, 0}, "N");
    writer.atom(name, "A", number, "C4", {at + 3.0, 0, 0}, "C");
    writer.atom(name, "A", number, "O4", {at + 4.43, 0, 0}, "O");
}

// An asparagine with two sugars behind each other, the first 1.44 Å from ND2.
StructureWriter glycan() {
    StructureWriter writer;
    writer.atom("ASN", "A", 1, "N", {-6, 4, 0}, "N").atom("ASN", "A", 1, "CA", {-5, 3, 0}, "C");
    writer.atom("ASN", "A", 1, "C", {-6, 2, 0}, "C").atom("ASN", "A", 1, "O", {-7.2, 2, 0}, "O");
    writer.atom("ASN", "A", 1, "CB", {-4, 1.8, 0}, "C")
        .atom("ASN", "A", 1, "CG", {-2.7, 0.8, 0}, "C");
    writer.atom("ASN", "A", 1, "OD1", {-2.7, -0.4, 0}, "O");
    writer.atom("ASN", "A", 1, "ND2", {-1.44, 0, 0}, "N").end_chain();
    add_sugar(writer, "NAG", 2, 0);
    add_sugar(writer, "NAG", 3, 5.86);
    return writer;
}

struct Linked {
    NamedResidues named;
    Structure structure;
    GenerateSettings generate;
    Report report;
};

Linked link_all(const Structure& structure) {
    Linked result;
    result.named = name_residues(linked_force_field(), structure, {}, result.report);
    result.named.problems.throw_if_any();
    Structure split = result.named.structure;
    result.generate = split_segments(linked_force_field(), split, result.named.patches, {},
                                     result.report, result.named.links);
    result.structure = name_atoms(linked_force_field(), split, result.generate, result.report);
    return result;
}

std::string patches_of(const GenerateSettings& generate) {
    std::string text;
    for (const PatchUse& use : generate.patches) {
        text += use.patch;
        for (const ResidueId& id : use.residues) text += " " + id.number;
        text += "; ";
    }
    return text;
}

// One after the other, each O3' 1.6 Å before the next P; atoms without a base.
void add_nucleotide(StructureWriter& writer, int number, const std::string& name, bool has_p,
                    bool is_ribose, const std::string& prime) {
    const double at = 8.0 * number;
    const auto add = [&](const std::string& atom, double x, double y, const std::string& element) {
        writer.atom(name, "B", number, atom, {at + x, y, 0}, element);
    };
    if (has_p) add("P", 0, 0, "P");
    if (has_p) add("OP1", 0, 1.5, "O");
    add("O5" + prime, 1.6, 0, "O");
    add("C5" + prime, 3.0, 0, "C");
    add("C4" + prime, 4.0, 1.1, "C");
    add("C3" + prime, 5.4, 0.9, "C");
    add("O3" + prime, 6.4, 0, "O");
    add("C2" + prime, 5.9, 2.3, "C");
    if (is_ribose) add("O2" + prime, 7.2, 2.6, "O");
    add("C1" + prime, 4.9, 3.4, "C");
}

}  // namespace

TEST_CASE("sugars get CHARMM's names and the patches of their bonds", "[prepare][links]") {
    const Linked linked = link_all(glycan().structure());

    CHECK(linked.structure.names.back().residue == "BGLCNA");
    CHECK(patches_of(linked.generate) == "NGLB 1 2; 14BB 2 3; ");
    // N2 is CHARMM's N; names that are the same stay.
    CHECK_THAT(joined_names(linked.structure), Contains("C1 C2 N C4 O4 C1 C2 N C4 O4 "));
    CHECK_THAT(linked.report.to_text(), Contains("by distance, patch NGLB"));
    CHECK(linked.report.warnings().empty());
}

TEST_CASE("a link that a file states is a bond, and one without a patch is warned of",
          "[prepare][links]") {
    StructureWriter writer = glycan();
    writer.atom("MAN", "A", 4, "C1", {12.2, 0, 0}, "C")
        .atom("MAN", "A", 4, "O6", {13.6, 0, 0}, "O");
    Structure structure = writer.structure();
    CHECK(patches_of(link_all(structure).generate) == "NGLB 1 2; 14BB 2 3; ");

    structure.links.push_back({{"A", "NAG", "3", "O4"}, {"A", "MAN", "4", "C1"}, 1});
    const Linked stated = link_all(structure);  // 1.9 Å apart
    CHECK(patches_of(stated.generate) == "NGLB 1 2; 14BB 2 3; 14AB 3 4; ");
    CHECK_THAT(stated.report.to_text(), Contains("as the file says, patch 14AB"));

    structure.links.back() = {{"A", "NAG", "3", "C4"}, {"A", "MAN", "4", "C1"}, 1};
    structure.positions[structure.names.size() - 2] = structure.positions[16] + Vec3(0, 1.5, 0);
    structure.positions.back() = structure.positions[16] + Vec3(0, 2.9, 0);
    const Linked without = link_all(structure);
    REQUIRE(without.report.warnings().size() >= 1);
    CHECK_THAT(without.report.warnings()[0], Contains("the force field has no patch"));
}

TEST_CASE("nucleotides without O2' are DNA, with ends by their phosphates", "[prepare][links]") {
    for (const std::string prime : {"'", "*"}) {
        INFO(prime);
        StructureWriter dna;
        add_nucleotide(dna, 1, "DC", false, false, prime);
        add_nucleotide(dna, 2, "DC", true, false, prime);
        const Linked linked = link_all(dna.structure());
        CHECK(patches_of(linked.generate) == "DEO5 1; DEOX 2; ");
        REQUIRE(linked.generate.segments.size() == 1);
        CHECK(linked.generate.segments[0].first == "5TER");
        CHECK(linked.generate.segments[0].last == "3TER");
        CHECK_THAT(joined_names(linked.structure), Contains("P O1P O5' C5'"));
    }
    StructureWriter rna;
    add_nucleotide(rna, 1, "C", true, true, "'");
    add_nucleotide(rna, 2, "C", true, true, "'");
    const Linked linked = link_all(rna.structure());
    CHECK(linked.generate.patches.empty());
    CHECK(linked.generate.segments.at(0).first == "5PHO");
}

TEST_CASE("a molecule that is only called alike is not taken", "[prepare][links]") {
    StructureWriter same;
    for (int i = 0; i < 4; ++i) {
        same.atom("CA", "A", 1, "X" + std::to_string(i), {1.5 * i, 0, 0}, "C");
    }
    CHECK(joined_names(link_all(same.structure()).structure) == "C1 C2 C3 C4 ");

    StructureWriter other;  // a carbon with three others: no chain
    other.atom("CA", "A", 1, "X1", {0, 0, 0}, "C").atom("CA", "A", 1, "C2", {1.5, 0, 0}, "C");
    other.atom("CA", "A", 1, "C3", {0, 1.5, 0}, "C").atom("CA", "A", 1, "C4", {0, 0, 1.5}, "C");
    CHECK_THAT(load_error_of([&] { link_all(other.structure()); }),
               Contains("no topology for residue 'CA'"));
}

TEST_CASE("ions are known by their names, whatever else has them", "[prepare][links]") {
    for (const char* const name : {"NA", "NA+", "SOD"}) {
        INFO(name);
        StructureWriter writer;
        writer.atom(name, "A", 1, "NA", {0, 0, 0}, "NA");
        CHECK(link_all(writer.structure()).structure.names[0].residue == "SOD");
    }
}

TEST_CASE("residues that a force field lacks are listed by kind with what to do",
          "[prepare][links]") {
    StructureWriter writer;
    writer.atom("BMA", "A", 1, "C1", {0, 0, 0}, "C").atom("BMA", "A", 1, "C2", {1.5, 0, 0}, "C");
    writer.atom("ANP", "A", 2, "PG", {9, 0, 0}, "P").atom("ANP", "A", 2, "O1G", {9, 1.5, 0}, "O");
    Report report;
    const NamedResidues named = name_residues(linked_force_field(), writer.structure(), {}, report);
    REQUIRE(named.unknown.size() == 2);
    CHECK(named.unknown[1].meaning == "beta-D-mannose");
    CHECK_THAT(advise(named.unknown[1], AdviceFor::CommandLine),
               Catch::StartsWith("add top_all36_carb.rtf, par_all36_carb.prm and ") &&
                   Catch::EndsWith(" (--toppar), leave it out (--without BMA) or approximate it "
                                   "(--approximate-ligands)"));
    CHECK(named.unknown[0].meaning == "AMP-PNP, an analogue of ATP");
    CHECK(named.unknown[0].where == std::vector<std::string>{"A:2"});
    CHECK_THAT(advise(named.unknown[0], AdviceFor::CommandLine), Contains("--without ANP"));
    // The window has keys, not options.
    CHECK_THAT(advise(named.unknown[0], AdviceFor::Window),
               Contains("leave it out (L) or approximate it (A)") && !Contains("--"));
}

TEST_CASE("no name stands in two tables, and all have letters of the PDB", "[prepare][links]") {
    std::vector<std::string_view> names;
    for (const ComponentTable& table : component_tables()) {
        for (const Component& one : table.components) {
            names.push_back(one.name);
            CHECK(find_component(one.name)->component == &one);
            CHECK((!one.name.empty() && one.name.size() <= 3 && !one.meaning.empty()));
            // Left out as crystal's and known to the force field exclude each other.
            CHECK((crystal_only(one.name).empty() || one.charmm.empty()));
        }
    }
    std::sort(names.begin(), names.end());
    CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
    CHECK(crystal_only("SO4") == "sulphate");
    CHECK(crystal_only("ALA").empty());
}

// Whatever tree with rings is numbered anew, each atom finds one of its element and its bonds.
TEST_CASE("bonds find atoms however they are numbered", "[prepare][links]") {
    std::mt19937 random(1);
    for (int run = 0; run < 200; ++run) {
        const std::uint32_t count = 3 + static_cast<std::uint32_t>(random() % 25);
        BondedAtoms wanted;
        wanted.neighbours.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            wanted.names.push_back("T" + std::to_string(i));
            wanted.elements.emplace_back(random() % 3 == 0 ? "N" : "C");
            if (i > 0) wanted.add_bond(i, static_cast<std::uint32_t>(random()) % i);
        }
        wanted.add_bond(0, count - 1);
        std::vector<std::uint32_t> order(count);
        for (std::uint32_t i = 0; i < count; ++i) order[i] = i;
        std::shuffle(order.begin(), order.end(), random);
        BondedAtoms given;
        given.neighbours.resize(count);
        std::vector<std::uint32_t> place(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            given.names.push_back("G" + std::to_string(i));
            given.elements.push_back(wanted.elements[order[i]]);
            place[order[i]] = i;
        }
        for (std::uint32_t a = 0; a < count; ++a) {
            for (const std::uint32_t b : wanted.neighbours[a]) given.add_bond(place[a], place[b]);
        }

        const auto match = match_by_bonds(given, wanted);

        REQUIRE(match);
        std::vector<bool> is_taken(count, false);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t to = (*match)[i];
            CHECK_FALSE(is_taken[to]);
            is_taken[to] = true;
            CHECK(wanted.elements[to] == given.elements[i]);
            for (const std::uint32_t other : given.neighbours[i]) {
                const auto& near = wanted.neighbours[to];
                CHECK(std::find(near.begin(), near.end(), (*match)[other]) != near.end());
            }
        }
        given.elements[0] = "S";
        CHECK_FALSE(match_by_bonds(given, wanted));
    }
}
