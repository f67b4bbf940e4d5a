#include "prepare/choose.h"

#include "tests/prepare/small_system.h"
#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <string>

using namespace palpa;
using Catch::Contains;
using test::joined_names;
using test::load_error_of;
using test::StructureWriter;

TEST_CASE("of two locations the more occupied one is taken, or the one asked for", "[prepare]") {
    StructureWriter writer;
    writer.atom("ALA", "A", 1, "CA", {0, 0, 0}, "C");
    writer.atom("ALA", "A", 1, "CB", {1, 0, 0}, "C", 'A', 0.4);
    writer.atom("ALA", "A", 1, "CB", {2, 0, 0}, "C", 'B', 0.6);
    Report report;
    const Structure chosen = choose_atoms(writer.structure(), {}, report);
    REQUIRE(chosen.names.size() == 2);
    CHECK(chosen.positions[1].x() == 2);
    CHECK(chosen.records[1].alternate == ' ');
    CHECK_THAT(report.to_text(), Contains("ALA A 1: location B of A B (occupancy 0.60)"));

    PrepareSettings settings;
    settings.alternates = {{{"A", "1"}, 'A'}};
    CHECK(choose_atoms(writer.structure(), settings, report).positions[1].x() == 1);
    settings.alternates = {{{"A", "1"}, 'C'}};
    CHECK_THAT(load_error_of([&] { choose_atoms(writer.structure(), settings, report); }),
               Contains("ALA A 1 has no alternate location 'C'"));
}

TEST_CASE("atoms that the chosen location lacks come from another", "[prepare]") {
    StructureWriter writer;
    writer.atom("ALA", "A", 1, "CA", {0, 0, 0}, "C", 'A', 0.4);
    writer.atom("ALA", "A", 1, "CA", {1, 0, 0}, "C", 'B', 0.3);
    writer.atom("ALA", "A", 1, "CB", {2, 0, 0}, "C", 'C', 0.9);
    Report report;
    const Structure chosen = choose_atoms(writer.structure(), {}, report);
    REQUIRE(joined_names(chosen) == "CA CB ");
    CHECK(chosen.positions[0].x() == 0);
}

TEST_CASE("equal locations: the first of the alphabet, and two residues in one place",
          "[prepare]") {
    StructureWriter writer;
    writer.atom("SER", "A", 1, "CA", {5, 0, 0}, "C", 'B', 0.5);
    writer.atom("ALA", "A", 1, "CA", {0, 0, 0}, "C", 'A', 0.5);
    Report report;
    const Structure chosen = choose_atoms(writer.structure(), {}, report);
    REQUIRE(chosen.names.size() == 1);
    CHECK(chosen.names[0].residue == "ALA");
}

TEST_CASE("the first model counts unless another is asked for", "[prepare]") {
    StructureWriter writer;
    writer.model = 3;
    writer.atom("ALA", "A", 1, "CA", {3, 0, 0}, "C");
    writer.model = 7;
    writer.atom("ALA", "A", 1, "CA", {7, 0, 0}, "C");
    Report report;
    CHECK(choose_atoms(writer.structure(), {}, report).positions[0].x() == 3);
    PrepareSettings settings;
    settings.model = 7;
    CHECK(choose_atoms(writer.structure(), settings, report).positions[0].x() == 7);
    settings.model = 1;
    CHECK_THAT(load_error_of([&] { choose_atoms(writer.structure(), settings, report); }),
               Contains("no model 1 (only 3, 7)"));
}

TEST_CASE("waters go, ions stay, and what is asked for goes", "[prepare]") {
    StructureWriter writer;
    writer.atom("ALA", "A", 1, "CA", {0, 0, 0}, "C").end_chain();
    writer.atom("MK1", "B", 902, "C1", {5, 0, 0}, "C");
    writer.atom("HOH", "A", 301, "O", {9, 0, 0}, "O");
    writer.atom("NA", "A", 302, "NA", {9, 9, 0}, "NA");
    Report report;
    CHECK(joined_names(choose_atoms(writer.structure(), {}, report)) == "CA C1 NA ");
    PrepareSettings settings;
    settings.keeps_waters = true;
    settings.keeps_ions = false;
    for (const char* const word : {"MK1", "chain:B", "B:902"}) {
        settings.without = {word};
        const Structure chosen = choose_atoms(writer.structure(), settings, report);
        CHECK(joined_names(chosen) == "CA O ");
        CHECK(chosen.chain_ends == std::vector<std::size_t>{1});
    }
    settings.without = {"MK2"};
    CHECK_THAT(load_error_of([&] { choose_atoms(writer.structure(), settings, report); }),
               Contains("the structure has no 'MK2'; did you mean 'MK1'?"));
    settings.without = {"ALA", "MK1", "HOH"};
    CHECK_THAT(load_error_of([&] { choose_atoms(writer.structure(), settings, report); }),
               Contains("no atom remains"));
}
