#include "molecule/alternatives.h"

#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <string>

using namespace palpa;

namespace {

// One atom in some places, on lines from 1.
Structure structure_of(const std::string& alternates, const std::string& models) {
    Structure structure;
    structure.file = "a.pdb";
    for (std::size_t i = 0; i < alternates.size(); ++i) {
        structure.names.push_back({"A", "PHE", "53", "N"});
        structure.positions.emplace_back(0, 0, 0);
        structure.lines.push_back(i + 1);
        AtomRecord record;
        record.chain = "A";
        record.alternate = alternates[i];
        record.model = models[i] - '0';
        structure.records.push_back(record);
    }
    return structure;
}

std::string error_of(const Structure& structure) {
    return test::load_error_of([&] { refuse_alternatives(structure); });
}

}  // namespace

TEST_CASE("an atom in alternate locations or models is refused with both places", "[molecule]") {
    CHECK(error_of(structure_of("A", "1")) == "no error");
    CHECK(error_of(structure_of("AB", "11")) ==
          "a.pdb:2: atom A PHE 53 N is repeated in location B, first in location A on line 1; "
          "expected one position for each atom (palpa prepare chooses one)");
    CHECK_THAT(
        error_of(structure_of("  ", "12")),
        Catch::StartsWith("a.pdb:2: atom A PHE 53 N is repeated in model 2, first in model 1 on "
                          "line 1; expected"));
    CHECK_THAT(error_of(structure_of("ABC", "111")),
               Catch::Contains("on line 1 (2 repeated lines);"));
    // Two residues in one place are alternatives as well.
    Structure mixed = structure_of("AB", "11");
    mixed.names[1].residue = "TYR";
    CHECK_THAT(error_of(mixed),
               Catch::StartsWith("a.pdb:2: atom A TYR 53 N is repeated in location B"));
    mixed.names[1].number = "53A";
    CHECK(error_of(mixed) == "no error");
}
