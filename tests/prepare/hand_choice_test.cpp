#include "prepare/hand_choice.h"

#include "tests/prepare/small_system.h"
#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;
using test::StructureWriter;

namespace {

// Every segment one piece.
std::vector<SystemSegment> segments_of(const Structure& structure) {
    Connectivity connectivity;
    for (std::uint32_t i = 1; i < structure.names.size(); ++i) {
        if (structure.names[i].segment == structure.names[i - 1].segment)
            connectivity.bonds.push_back({i - 1, i});
    }
    return find_segments(structure, connectivity);
}

// A chain of four atoms a residue, 4 Å from one to the next.
StructureWriter& add_chain(StructureWriter& writer, const std::string& name, int residues) {
    for (int i = 0; i < residues; ++i) writer.backbone("ALA", name, i + 1, 4.0 * i);
    return writer;
}

}  // namespace

TEST_CASE("a small molecule beside a larger one is held whole", "[prepare][hand]") {
    StructureWriter writer;
    add_chain(writer, "A", 5);
    for (int i = 0; i < 4; ++i) {
        writer.atom("LIG", "L", 1, "C" + std::to_string(i), {9.0 + i, 5, 0}, "C");
    }
    writer.atom("SOD", "I", 1, "SOD", {30, 0, 0}, "NA");
    const HandChoice hand = choose_hand(writer.structure(), segments_of(writer.structure()), "");
    CHECK(hand.segment == "L");
    CHECK(hand.atom.empty());
    CHECK(hand.held == std::vector<std::uint32_t>{20, 21, 22, 23});
}

TEST_CASE("the choice, other molecules and residues are offered, each once", "[prepare][hand]") {
    StructureWriter writer;
    add_chain(writer, "A", 5);
    add_chain(writer, "B", 3);
    for (int i = 0; i < 4; ++i) {
        writer.atom("LIG", "L", 1, "C" + std::to_string(i), {9.0 + i, 5, 0}, "C");
    }
    writer.atom("SOD", "I", 1, "SOD", {30, 0, 0}, "NA");
    const std::vector<SystemSegment> segments = segments_of(writer.structure());
    std::vector<std::string> grabs;
    for (const HandChoice& choice : list_hand_choices(writer.structure(), segments)) {
        grabs.push_back(grab_of(choice));
        // Each can be asked for.
        CHECK(choose_hand(writer.structure(), segments, grabs.back()).held == choice.held);
    }
    REQUIRE(grabs.size() == 5);
    CHECK(grabs[0] == "L");
    CHECK(grabs[1] == "B");
    CHECK(grabs[2] == "A");
    CHECK(grabs[3].starts_with("B:"));
    CHECK(grabs[4].starts_with("A:"));
    CHECK(list_hand_choices(writer.structure(), segments, 2).size() == 2);
    CHECK(list_hand_choices(writer.structure(), std::span(segments).last(1)).empty());
}

TEST_CASE("of one chain the most exposed residue is held", "[prepare][hand]") {
    // 80 residues in a row of 4 Å: at both ends they have half as many neighbours, and something
    // that is no molecule lies beside the first of them.
    StructureWriter writer;
    add_chain(writer, "A", 80);
    for (int i = 0; i < 3; ++i) writer.atom("SOD", "I", i + 1, "SOD", {2.0 * i, 5, 0}, "NA");
    const HandChoice hand = choose_hand(writer.structure(), segments_of(writer.structure()), "");
    CHECK(hand.segment == "A");
    CHECK(hand.atom == "80");
    CHECK(hand.held == std::vector<std::uint32_t>{316, 317, 318, 319});
    CHECK_THAT(hand.words, Contains("ALA 80 of A"));
}

TEST_CASE("of several chains the smallest is held whole, of those alike the last",
          "[prepare][hand]") {
    StructureWriter writer;
    add_chain(add_chain(writer, "A", 80), "B", 76);
    const Structure& structure = writer.structure();
    HandChoice hand = choose_hand(structure, segments_of(structure), "");
    CHECK(hand.segment == "B");
    CHECK(hand.atom.empty());
    CHECK(hand.held.size() == 304);

    hand = choose_hand(structure, segments_of(structure), "B:7");
    CHECK(hand.segment == "B");
    CHECK(hand.atom == "7");
    Structure joined = structure;
    for (std::size_t i = 0; i < joined.names.size(); ++i) {
        if (joined.names[i].segment != "B") continue;
        joined.names[i].number = "B:" + joined.names[i].number;  // as where segments are joined
        joined.names[i].segment = "A";
    }
    hand = choose_hand(joined, segments_of(joined), "B:7");
    CHECK(hand.segment == "A");
    CHECK(hand.atom == "B:7");
    hand = choose_hand(structure, segments_of(structure), "A");
    CHECK(hand.atom.empty());
    CHECK(hand.held.size() == 320);
    CHECK_THAT(load_error_of([&] { choose_hand(structure, segments_of(structure), "B:77"); }),
               Contains("--grab B:77") && Contains("A, B"));

    StructureWriter dimer;
    add_chain(add_chain(dimer, "A", 10), "B", 10);
    hand = choose_hand(dimer.structure(), segments_of(dimer.structure()), "");
    CHECK(hand.segment == "B");
    CHECK(hand.held.size() == 40);
    StructureWriter large;
    add_chain(add_chain(large, "A", 501), "B", 501);  // of 2,004 atoms each
    hand = choose_hand(large.structure(), segments_of(large.structure()), "");
    CHECK(hand.segment == "A");
    CHECK_FALSE(hand.atom.empty());
}

TEST_CASE("a single residue is held by an atom, and its whole molecule by nothing",
          "[prepare][hand]") {
    StructureWriter writer;
    writer.backbone("ALA", "A", 1, 0);
    const std::vector<SystemSegment> segments = segments_of(writer.structure());
    CHECK_THAT(choose_hand(writer.structure(), segments, "").atom, Contains("1 "));
    CHECK_THAT(load_error_of([&] { choose_hand(writer.structure(), segments, "A"); }),
               Contains("--grab A"));
    StructureWriter ion;
    ion.atom("SOD", "I", 1, "SOD", {0, 0, 0}, "NA");
    CHECK_THAT(
        load_error_of([&] { choose_hand(ion.structure(), segments_of(ion.structure()), ""); }),
        Contains("no molecule to hold"));
}

TEST_CASE("the way out of a cup is its opening", "[prepare][hand]") {
    const Vec3 opening = Vec3(1, -2, 2) / 3;
    StructureWriter writer;
    writer.atom("LIG", "L", 1, "C", {0, 0, 0}, "C");
    int walls = 0;
    for (int i = 0; i < 500; ++i) {  // evenly on a sphere of 7 Å, but for a hole of 45 degrees
        const double z = 1 - (2 * i + 1.0) / 500, across = std::sqrt(1 - z * z), turn = 2.4 * i;
        const Vec3 place(across * std::cos(turn), across * std::sin(turn), z);
        if (place.dot(opening) > std::numbers::sqrt2 / 2) continue;
        writer.atom("WAL", "W", ++walls, "C", 7 * place, "C");
    }
    const std::vector<std::uint32_t> held{0};
    // Within the hole and clear of its edge: 45 degrees less what 3 Å of 7 are, and the grid's
    // step.
    CHECK(find_way_out(writer.structure(), held).dot(opening) >
          std::cos(25 * std::numbers::pi / 180));
}
