#include "charmm/topology.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

Exclusions exclusions_of(std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> bonds,
                         std::size_t atom_count) {
    std::vector<Bond> list;
    for (const auto& [a, b] : bonds) list.push_back({a, b, 0, 0});
    return build_exclusions(list, atom_count);
}

std::vector<std::uint32_t> row(const Exclusions& exclusions, std::size_t atom) {
    const auto atoms = exclusions.of(atom);
    return {atoms.begin(), atoms.end()};
}

using Row = std::vector<std::uint32_t>;
using Pairs = std::vector<std::array<std::uint32_t, 2>>;

}  // namespace

TEST_CASE("a chain excludes what is up to three bonds away", "[charmm][topology]") {
    const Exclusions chain = exclusions_of({{1, 0}, {1, 2}, {3, 2}, {3, 4}, {4, 5}}, 7);

    CHECK(row(chain, 0) == Row{1, 2, 3});
    CHECK(row(chain, 1) == Row{2, 3, 4});
    CHECK(row(chain, 4) == Row{5});
    CHECK(row(chain, 6).empty());
    CHECK(chain.pairs14 == Pairs{{0, 3}, {1, 4}, {2, 5}});
}

TEST_CASE("in a ring the shorter way counts", "[charmm][topology]") {
    const Exclusions five = exclusions_of({{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}}, 5);
    const Exclusions six = exclusions_of({{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 0}}, 6);

    CHECK(row(five, 0) == Row{1, 2, 3, 4});
    CHECK(five.pairs14.empty());
    // Two ways lead across a ring of six; the pair is there once.
    CHECK(six.pairs14 == Pairs{{0, 3}, {1, 4}, {2, 5}});
}

TEST_CASE("a bond given twice counts once, and atoms without bonds exclude nothing",
          "[charmm][topology]") {
    const Exclusions exclusions = exclusions_of({{0, 2}, {2, 0}}, 4);

    CHECK(row(exclusions, 0) == Row{2});
    CHECK(row(exclusions, 1).empty());
    CHECK(row(exclusions, 3).empty());
    CHECK(exclusions.pairs14.empty());
    CHECK(build_exclusions({}, 0).first == Row{0});
}

TEST_CASE("Lennard-Jones numbers are combined as CHARMM does, but for NBFIX pairs",
          "[charmm][topology]") {
    const std::vector<LennardJonesType> types{{0.1521, 1.7682}, {0.046, 0.2245}, {0.07, 1.9924}};

    const LennardJonesTable table =
        build_lennard_jones_table(types, std::array{Nbfix{2, 1, {9, 9}}, Nbfix{1, 2, {0.3, 2.5}}});

    CHECK(table.row(0)[1].epsilon == Approx(std::sqrt(0.1521 * 0.046)).epsilon(1e-14));
    CHECK(table.row(0)[1].rmin == Approx(1.7682 + 0.2245).epsilon(1e-14));
    CHECK(table.row(0)[0].rmin == 2 * 1.7682);
    CHECK(table.row(1)[2].epsilon == 0.3);
    CHECK(table.row(2)[1].epsilon == 0.3);
    CHECK(table.row(2)[1].rmin == 2.5);
}
