// Amides and histidines turn for a partner alone, and hydrogens are where they bond.
#include "prepare/choose_states.h"

#include "formats/pdb.h"
#include "prepare/turned_sites.h"
#include "tests/prepare/small_system.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::StructureWriter;

namespace {

// A ring with its two nitrogens 2.2 Å apart, ND1 at the origin, pointing to -y, NE2 to +y.
StructureWriter histidine() {
    StructureWriter writer;
    writer.atom("HIS", "A", 1, "N", {-5, 0, 0}, "N");
    writer.atom("HIS", "A", 1, "CA", {-4, 0, 0}, "C");
    writer.atom("HIS", "A", 1, "C", {-4, 1.5, 0}, "C");
    writer.atom("HIS", "A", 1, "O", {-5, 2, 0}, "O");
    writer.atom("HIS", "A", 1, "CB", {-2.6, 0, 0}, "C");
    writer.atom("HIS", "A", 1, "CG", {-1.2, 0.6, 0}, "C");
    writer.atom("HIS", "A", 1, "ND1", {0, 0, 0}, "N");
    writer.atom("HIS", "A", 1, "CE1", {1, 1.1, 0}, "C");
    writer.atom("HIS", "A", 1, "NE2", {0.2, 2.2, 0}, "N");
    writer.atom("HIS", "A", 1, "CD2", {-1.1, 2.0, 0}, "C");
    return writer;
}

// The carbonyl of a residue far along the chain, its oxygen here and its carbon behind it.
void add_carbonyl(StructureWriter& writer, int number, const Vec3& oxygen, const Vec3& carbon) {
    writer.atom("ALA", "A", number, "C", carbon, "C").atom("ALA", "A", number, "O", oxygen, "O");
}

void add_amine(StructureWriter& writer, int number, const Vec3& nitrogen, const Vec3& carbon) {
    writer.atom("LYS", "A", number, "CE", carbon, "C");
    writer.atom("LYS", "A", number, "NZ", nitrogen, "N");
}

void add_acid(StructureWriter& writer, int number, const Vec3& oxygen, const Vec3& carbon) {
    writer.atom("GLU", "A", number, "CD", carbon, "C");
    writer.atom("GLU", "A", number, "OE1", oxygen, "O");
}

// C in the plane z = 0 at the origin, O and N at +y and -y of it, both towards +x.
StructureWriter glutamine() {
    StructureWriter writer;
    writer.atom("GLN", "A", 1, "CG", {-1.5, 0, 0}, "C").atom("GLN", "A", 1, "CD", {0, 0, 0}, "C");
    writer.atom("GLN", "A", 1, "OE1", {0.62, 1.06, 0}, "O");
    writer.atom("GLN", "A", 1, "NE2", {0.66, -1.15, 0}, "N");
    return writer;
}

ChosenState state_of(const StructureWriter& writer, const std::vector<Vec3>& waters = {}) {
    for (ChosenState& state :
         choose_states(writer.structure(), {.waters = waters, .given = {}, .held = {}})) {
        if (state.residue == 0) return state;
    }
    return {};
}

}  // namespace

TEST_CASE("a histidine's neighbours decide where its hydrogen is", "[prepare]") {
    CHECK(state_of(histidine()).histidine == "HSE");
    CHECK_THAT(state_of(histidine()).reason, Contains("no hydrogen bond decides"));
    StructureWriter acceptor = histidine();
    add_carbonyl(acceptor, 9, {0.3, -2.8, 0}, {0.3, -4.0, 0});
    CHECK(state_of(acceptor).histidine == "HSD");
    StructureWriter behind = histidine();  // near, but ND1 does not point there
    add_carbonyl(behind, 9, {0.1, 0, 3}, {0.1, 0, 4.2});
    CHECK(state_of(behind).histidine == "HSE");
    StructureWriter giver = histidine();
    add_amine(giver, 9, {0.6, 5.0, 0}, {0.6, 6.5, 0});
    CHECK(state_of(giver).histidine == "HSD");
    StructureWriter metal = histidine();
    metal.atom("ZN", "A", 9, "ZN", {0.5, 4.2, 0}, "ZN");
    CHECK(state_of(metal).histidine == "HSD");
    StructureWriter both = histidine();
    add_carbonyl(both, 9, {0.3, -2.8, 0}, {0.3, -4.0, 0});
    add_carbonyl(both, 8, {0.6, 5, 0}, {0.6, 6.2, 0});
    CHECK(state_of(both).might_be_charged);
    StructureWriter with_hydrogen = histidine();  // which outweighs all
    with_hydrogen.atom("HIS", "A", 1, "HE2", {0.5, 3.1, 0}, "H");
    add_carbonyl(with_hydrogen, 9, {0.3, -2.8, 0}, {0.3, -4.0, 0});
    CHECK(state_of(with_hydrogen).histidine == "HSE");
}

// As B 69 of 1HPV: the oxygens are within reach, one 63 degrees aside and one a little far.
TEST_CASE("acceptors at the edge of their range decide where nothing else does", "[prepare]") {
    StructureWriter aside = histidine();
    add_carbonyl(aside, 9, {2.73, -1.4, 0}, {3.8, -2.0, 0});
    add_carbonyl(aside, 8, {-2.0, -2.8, 0}, {-2.7, -3.8, 0});
    CHECK(state_of(aside).histidine == "HSD");
    CHECK_THAT(state_of(aside).reason, Contains("ND1 donates to ALA A"));
}

TEST_CASE("between a carbonyl and an acid a histidine is charged and stays", "[prepare]") {
    StructureWriter writer = histidine();
    add_carbonyl(writer, 9, {0.3, -2.8, 0}, {0.3, -4.0, 0});
    add_acid(writer, 8, {0.6, 5, 0}, {0.6, 6.2, 0});
    const ChosenState state = state_of(writer);
    CHECK(state.histidine == "HSP");
    CHECK_FALSE(state.is_flipped);
    CHECK_FALSE(state.might_be_charged);
}

TEST_CASE("a ring turns where a carbon stands between its nitrogen's partners", "[prepare]") {
    // By hand: turned about the bond CB-CG, ND1 is at (-0.81, 1.88) and points along (-0.64, 0.77).
    StructureWriter writer = histidine();
    add_carbonyl(writer, 9, {-2.66, 4.11, 0}, {-3.45, 5.06, 0});
    const ChosenState state = state_of(writer);
    CHECK(state.is_flipped);
    CHECK(state.histidine == "HSD");
    StateSettings still{.may_flip = false, .waters = {}, .given = {}, .held = {}};
    CHECK_FALSE(choose_states(writer.structure(), still).at(0).is_flipped);
    const std::vector<std::size_t> given{0};
    CHECK(choose_states(writer.structure(), {.waters = {}, .given = given, .held = {}}).empty());
}

TEST_CASE("an amide turns for a partner alone", "[prepare]") {
    // As GLN 40 and 62 of 1UBQ: nothing, or a water, is near, whatever charges are farther away.
    CHECK_FALSE(state_of(glutamine()).is_flipped);
    CHECK_FALSE(state_of(glutamine(), {{1.6, 3.7, 0}}).is_flipped);
    CHECK_FALSE(state_of(glutamine(), {{1.6, -3.9, 0}}).is_flipped);
    StructureWriter far = glutamine();
    add_acid(far, 5, {1.6, 6.5, 0}, {1.6, 7.7, 0});
    CHECK_FALSE(state_of(far).is_flipped);

    StructureWriter acceptor = glutamine();  // before the oxygen
    add_carbonyl(acceptor, 5, {1.9, 3.6, 0}, {2.4, 4.7, 0});
    const ChosenState turned = state_of(acceptor);
    CHECK(turned.is_flipped);
    CHECK(turned.gain > 0.5);
    CHECK_THAT(turned.reason, Contains("NE2 donates to ALA A 5 O"));
    const std::vector<std::size_t> held{0};
    CHECK(choose_states(acceptor.structure(), {.waters = {}, .given = {}, .held = held}).empty());
    StructureWriter good = glutamine();  // before the nitrogen
    add_carbonyl(good, 5, {0.66, -4.05, 0}, {0.66, -5.3, 0});
    CHECK_FALSE(state_of(good).is_flipped);
    StructureWriter glycan = acceptor;
    const std::vector<std::size_t> given{0};
    CHECK(choose_states(glycan.structure(), {.waters = {}, .given = given, .held = {}}).empty());
}

TEST_CASE("two amides that face each other turn together or not at all", "[prepare]") {
    // O faces O: one of them turns, not both.
    StructureWriter writer = glutamine();
    writer.atom("GLN", "B", 2, "CG", {3.0, 4.9, 0}, "C")
        .atom("GLN", "B", 2, "CD", {1.9, 4.9, 0}, "C");
    writer.atom("GLN", "B", 2, "OE1", {1.28, 3.84, 0}, "O");
    writer.atom("GLN", "B", 2, "NE2", {1.24, 6.05, 0}, "N");
    const auto states = choose_states(writer.structure(), {});
    CHECK(std::ranges::count_if(states, [](const ChosenState& one) { return one.is_flipped; }) ==
          1);
}

TEST_CASE("half a turn exchanges the places of an amide's ends", "[prepare]") {
    Structure structure = glutamine().structure();
    flip(structure, find_residues(structure)[0]);
    // By hand: the axis is x, so y and z change sign.
    CHECK((structure.positions[2] - Vec3(0.62, -1.06, 0)).norm() < 1e-12);
    CHECK((structure.positions[3] - Vec3(0.66, 1.15, 0)).norm() < 1e-12);
}

namespace {

Structure without_hydrogens(const Structure& structure) {
    std::vector<bool> kept;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        kept.push_back(element_of(structure, i) != "H");
    }
    Structure result = keep_atoms(structure, kept);
    for (AtomName& name : result.names) {
        if (name.residue == "HSD" || name.residue == "HSE") name.residue = "HIS";
    }
    return result;
}

// Residues that turn, "GLN 40".
std::set<std::string> turned_in(const Structure& structure) {
    std::set<std::string> turned;
    for (const ChosenState& state : choose_states(structure, {})) {
        if (!state.is_flipped) continue;
        const AtomName& name = structure.names[state.residue];
        turned.insert(name.residue + " " + name.number);
    }
    return turned;
}

std::string_view histidine_of(const Structure& structure, const std::string& segment,
                              const std::string& number) {
    static std::vector<ChosenState> states;
    states = choose_states(structure, {.may_flip = false, .waters = {}, .given = {}, .held = {}});
    for (const ChosenState& state : states) {
        const AtomName& name = structure.names[state.residue];
        if (name.segment == segment && name.number == number) return state.histidine;
    }
    return {};
}

}  // namespace

TEST_CASE("ubiquitin's glutamines without partners stay, and its histidine", "[prepare]") {
    const auto file = test::find_shared_data("data/structures/1ubq.pdb");
    if (!file) return;
    const std::set<std::string> turned = turned_in(read_pdb(*file));
    CHECK_FALSE(turned.contains("GLN 40"));
    CHECK_FALSE(turned.contains("GLN 62"));
}

TEST_CASE("an oxygen 3.1 Å from a nitrogen of B 69 of 1HPV decides", "[prepare]") {
    const auto file = test::find_shared_data("data/hiv/1hpv_protein.pdb");
    if (!file) return;
    CHECK(histidine_of(read_pdb(*file), "B", "69") == "HSD");
}

// HIS 126 lies between Asp 146, Glu 151 and Arg 131; at 134 and 172 the acceptors Asp 118 O and
// Asp 113 OD1 are before NE2, and N of 136 and 137 before ND1 of 134: HSE by their hydrogen bonds,
// though CHARMM's own topology has its default, HSD, at all three.
TEST_CASE("adenylate kinase's histidines go by their hydrogen bonds", "[prepare]") {
    const auto file = test::find_shared_data("data/structures/adk_4ake_open.pdb");
    if (!file) return;
    const Structure all = read_pdb(*file);
    CHECK(choose_states(all, {}).size() == 0);  // named HSD, which stays
    const Structure heavy = without_hydrogens(all);
    CHECK(histidine_of(heavy, all.names[0].segment, "134") == "HSE");
    CHECK(histidine_of(heavy, all.names[0].segment, "172") == "HSE");
}
