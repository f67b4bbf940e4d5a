#include "molecule/match_atoms.h"

#include "tests/support/load_error_of.h"
#include "tests/support/structure_of.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

Connectivity connectivity_of(const std::vector<AtomName>& names) {
    Connectivity connectivity;
    connectivity.file = "a.psf";
    connectivity.names = names;
    for (std::size_t i = 0; i < names.size(); ++i) connectivity.lines.push_back(i + 8);
    return connectivity;
}

Structure structure_of(const std::vector<AtomName>& names) {
    return test::structure_of(names, "b.crd");
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

namespace {

// A residue's N and C, for each residue of a name and a number.
std::vector<AtomName> chain_of(const std::string& segment,
                               const std::vector<std::pair<std::string, std::string>>& residues) {
    std::vector<AtomName> names;
    for (const auto& [residue, number] : residues) {
        names.push_back({segment, residue, number, "N"});
        names.push_back({segment, residue, number, "C"});
    }
    return names;
}

std::vector<AtomName> joined(std::vector<AtomName> a, const std::vector<AtomName>& b) {
    for (const AtomName& name : b) a.push_back(name);
    return a;
}

// x of each atom that is found: its index in the structure.
std::vector<double> indices_of(const Connectivity& connectivity, const Structure& structure) {
    std::vector<double> indices;
    for (const Vec3& position : match_positions(connectivity, structure)) {
        indices.push_back(position.x());
    }
    return indices;
}

std::string error_of(const std::vector<AtomName>& wanted, const std::vector<AtomName>& there) {
    return test::load_error_of(
        [&] { match_positions(connectivity_of(wanted), structure_of(there)); });
}

}  // namespace

TEST_CASE("segments may be called otherwise where each fits one only", "[molecule]") {
    const auto first = [](const char* segment) {
        return chain_of(segment, {{"ALA", "1"}, {"GLY", "2"}});
    };
    const auto second = [](const char* segment) {
        return chain_of(segment, {{"ALA", "1"}, {"SER", "2"}});
    };
    CHECK(indices_of(connectivity_of(joined(first("P1"), second("P2"))),
                     structure_of(joined(second("X"), first("Y")))) ==
          std::vector<double>{4, 5, 6, 7, 0, 1, 2, 3});
    // P2 fits both, but P1 only Y: what it takes is no longer there for P2.
    const auto part = chain_of("P2", {{"ALA", "1"}});
    CHECK(indices_of(connectivity_of(joined(part, first("P1"))),
                     structure_of(joined(second("X"), first("Y")))) ==
          std::vector<double>{0, 1, 4, 5, 6, 7});
    // One chain for two segments, with an atom more.
    CHECK(
        indices_of(connectivity_of(joined(first("P1"), chain_of("LIG", {{"TL3", "9"}}))),
                   structure_of(joined(first("A"), chain_of("A", {{"HOH", "5"}, {"TL3", "9"}})))) ==
        std::vector<double>{0, 1, 2, 3, 6, 7});
    // Two chains for one segment.
    CHECK(indices_of(
              connectivity_of(first("P1")),
              structure_of(joined(chain_of("B", {{"GLY", "2"}}), chain_of("A", {{"ALA", "1"}})))) ==
          std::vector<double>{2, 3, 0, 1});
}

TEST_CASE("of chains alike a segment's name may tell which", "[molecule]") {
    const auto chain = [](const char* segment) { return chain_of(segment, {{"ALA", "1"}}); };

    CHECK(indices_of(connectivity_of(joined(chain("PROB"), chain("PROA"))),
                     structure_of(joined(chain("A"), chain("B")))) ==
          std::vector<double>{2, 3, 0, 1});
    // Which of them is meant is not for us to guess.
    CHECK(error_of(chain("P1"), joined(chain("A"), chain("B"))) ==
          "a.psf:8: 2 of its 2 atoms are not in b.crd: P1 ALA 1 N, P1 ALA 1 C; segments of this "
          "file: P1; segments or chains of the other: A, B; segment P1 matches A (b.crd:1) and B "
          "(b.crd:3) equally well; expected one match, or one named like the segment or its end");
    CHECK(error_of(joined(chain("P1"), chain("P2")), chain("A")) ==
          "a.psf:10: 2 of its 4 atoms are not in b.crd: P2 ALA 1 N, P2 ALA 1 C; segments of this "
          "file: P1, P2; segments or chains of the other: A");
}

TEST_CASE("a chain counts beside a segment", "[molecule]") {
    Structure structure =
        structure_of(joined(chain_of("S", {{"ALA", "1"}}), chain_of("T", {{"ALA", "1"}})));
    structure.records.resize(4);
    for (std::size_t i = 0; i < 4; ++i)
        structure.records[i].chain = std::string(1, i < 2 ? 'B' : 'A');

    CHECK(indices_of(connectivity_of(chain_of("A", {{"ALA", "1"}})), structure) ==
          std::vector<double>{2, 3});
}

TEST_CASE("residues that are numbered or called otherwise are told", "[molecule]") {
    const auto wanted = chain_of("P", {{"ALA", "1"}, {"HSD", "2"}, {"ALA", "3"}});

    CHECK_THAT(
        error_of(wanted,
                 chain_of("A", {{"GLY", "99"}, {"ALA", "101"}, {"HSD", "102"}, {"ALA", "103"}})),
        Catch::EndsWith("; residues of P have numbers 100 higher in A (b.crd:1); expected the same "
                        "numbers"));
    CHECK_THAT(error_of(wanted, chain_of("P", {{"ALA", "0"}, {"HSD", "1"}, {"ALA", "2"}})),
               Catch::Contains("numbers 1 lower in P"));
    CHECK_THAT(error_of(chain_of("P", {{"ALA", "-9223372036854775808"}}),
                        chain_of("A", {{"ALA", "9223372036854775807"}})),
               Catch::EndsWith("segments or chains of the other: A"));
    CHECK_THAT(
        error_of(wanted, chain_of("P", {{"ALA", "1"}, {"HIS", "2"}, {"ALA", "3"}})),
        Catch::StartsWith("a.psf:10: 2 of its 6 atoms are not in b.crd: P HSD 2 N, P HSD 2 C") &&
            Catch::EndsWith("; residue HSD 2 is HIS in b.crd:3; expected the same names"));
}

TEST_CASE("all atoms without a place are counted, the first few named", "[molecule]") {
    std::vector<AtomName> names;
    for (int i = 0; i < 20; ++i) names.push_back({"A", "ALA", fmt::format("{}", i), "N"});

    CHECK_THAT(error_of(names, {{"A", "ALA", "0", "N"}}),
               Catch::StartsWith("a.psf:9: 19 of its 20 atoms are not in b.crd: A ALA 1 N") &&
                   Catch::Contains("A ALA 8 N and 11 more; "));
}

TEST_CASE("an atom in two places is nobody's to choose", "[molecule]") {
    CHECK_THAT(
        error_of({{"A", "ALA", "1", "N"}}, {{"A", "ALA", "1", "N"}, {"A", "ALA", "1", "N"}}),
        Catch::StartsWith("b.crd:2: atom A ALA 1 N is repeated, first on line 1; expected one"));
    // Only where it is wanted.
    CHECK(indices_of(connectivity_of({{"A", "ALA", "1", "C"}}),
                     structure_of({{"A", "ALA", "1", "N"},
                                   {"A", "ALA", "1", "N"},
                                   {"A", "ALA", "1", "C"}})) == std::vector<double>{2});
}
