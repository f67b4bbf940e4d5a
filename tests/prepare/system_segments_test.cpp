#include "prepare/system_segments.h"

#include "tests/prepare/small_system.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;
using test::StructureWriter;

TEST_CASE("segments are molecules, waters, or neither", "[prepare][segments]") {
    StructureWriter writer;
    writer.backbone("ALA", "A", 1, 0);
    writer.atom("TIP3", "WA", 1, "OH2", {0, 9, 0}, "O");
    writer.atom("TIP3", "WA", 2, "OH2", {0, 12, 0}, "O");
    writer.atom("CAL", "IA", 1, "CAL", {0, 15, 0}, "CA");
    writer.backbone("ALA", "B", 1, 30);
    Connectivity connectivity;
    connectivity.bonds = {{0, 1}, {1, 2}, {2, 3}, {7, 8}, {8, 9}};  // the last atom of B is alone
    const std::vector<SystemSegment> segments = find_segments(writer.structure(), connectivity);
    REQUIRE(segments.size() == 4);
    CHECK(segments[0].kind == SegmentKind::Molecule);
    CHECK(segments[1].kind == SegmentKind::Water);
    CHECK(segments[2].kind == SegmentKind::Other);
    CHECK(segments[3].kind == SegmentKind::Other);
    CHECK(segments[1].name == "WA");
    CHECK(segments[1].atoms == std::vector<std::uint32_t>{4, 5});
}

TEST_CASE("segments that are bonded become one, and their residues stay apart",
          "[prepare][segments]") {
    StructureWriter writer;
    for (const char* const chain : {"A", "B", "C"}) writer.backbone("CYS", chain, 7, 0);
    Structure structure = writer.structure();
    Connectivity connectivity;
    connectivity.names = structure.names;
    connectivity.bonds = {{0, 1}, {4, 5}, {9, 2}};  // C to A
    const auto joined = join_bonded_segments(structure, connectivity);
    REQUIRE(joined == std::vector<std::vector<std::string>>{{"A", "C"}});
    CHECK(structure.names[0].number == "7");
    CHECK(structure.names[4].segment == "B");
    CHECK(structure.names[4].number == "7");
    CHECK(structure.names[8].segment == "A");
    CHECK(structure.names[8].number == "C:7");
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        CHECK(to_string(connectivity.names[i]) == to_string(structure.names[i]));
    }
    CHECK(join_bonded_segments(structure, connectivity).empty());
}
