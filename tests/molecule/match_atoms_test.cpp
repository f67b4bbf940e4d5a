#include "molecule/match_atoms.h"

#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;

namespace {

Connectivity connectivity_of(const std::vector<AtomName>& names) {
    Connectivity connectivity;
    connectivity.file = "a.psf";
    connectivity.names = names;
    return connectivity;
}

Structure structure_of(const std::vector<AtomName>& names) {
    Structure structure;
    structure.file = "b.crd";
    structure.names = names;
    for (std::size_t i = 0; i < names.size(); ++i) {
        structure.positions.emplace_back(static_cast<double>(i), 0, 0);
        structure.lines.push_back(i + 1);
    }
    return structure;
}

}  // namespace

TEST_CASE("atoms are found by name, whatever their order", "[molecule]") {
    const std::vector<AtomName> names{{"A", "ALA", "1", "N"}, {"A", "ALA", "1", "CA"}};
    const std::vector<Vec3> found = match_positions(
        connectivity_of(names),
        structure_of({{"A", "ALA", "1", "CA"}, {"W", "TIP3", "1", "OH2"}, {"A", "ALA", "1", "N"}}));
    REQUIRE(found.size() == 2);
    CHECK(found[0].x() == 2);
    CHECK(found[1].x() == 0);
}

TEST_CASE("segments may be called otherwise where an atom is the only one of its name",
          "[molecule]") {
    const Connectivity one = connectivity_of({{"PROA", "ALA", "1", "N"}});
    CHECK(match_positions(one, structure_of({{"A", "ALA", "1", "N"}}))[0].x() == 0);
    // Two chains: which of them is meant is not for us to guess.
    CHECK(test::load_error_of([&] {
              match_positions(one, structure_of({{"A", "ALA", "1", "N"}, {"B", "ALA", "1", "N"}}));
          }) == "b.crd: 1 of a.psf are not there: PROA ALA 1 N");
    const Connectivity two =
        connectivity_of({{"PROA", "ALA", "1", "N"}, {"PROB", "ALA", "1", "N"}});
    CHECK(test::load_error_of([&] {
              match_positions(two, structure_of({{"A", "ALA", "1", "N"}}));
          }) == "b.crd: 2 of a.psf are not there: PROA ALA 1 N, PROB ALA 1 N");
}

TEST_CASE("all atoms without a place are counted, the first few named", "[molecule]") {
    std::vector<AtomName> names;
    for (int i = 0; i < 20; ++i) names.push_back({"A", "ALA", std::to_string(i), "N"});
    const std::string message = test::load_error_of(
        [&] { match_positions(connectivity_of(names), structure_of({{"A", "ALA", "0", "N"}})); });
    CHECK_THAT(message, Catch::StartsWith("b.crd: 19 of a.psf are not there: A ALA 1 N"));
    CHECK_THAT(message, Catch::EndsWith("and 11 more"));
}

TEST_CASE("an atom in two places is nobody's to choose", "[molecule]") {
    const Connectivity one = connectivity_of({{"A", "ALA", "1", "N"}});
    CHECK_THAT(test::load_error_of([&] {
                   match_positions(one,
                                   structure_of({{"A", "ALA", "1", "N"}, {"A", "ALA", "1", "N"}}));
               }),
               Catch::Contains("A ALA 1 N is there more than once"));
}
