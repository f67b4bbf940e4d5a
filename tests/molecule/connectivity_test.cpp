#include "molecule/connectivity.h"

#include <fmt/format.h>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

using namespace palpa;

namespace {

using Pair = std::array<std::uint32_t, 2>;

// Atoms 0, 2, 3, 5 of segment A and 1, 4, 6 of segment B.
Connectivity two_segments() {
    Connectivity result;
    result.file = "two.psf";
    const std::string segments = "ABAABAB";
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const auto number = static_cast<double>(i);
        result.names.push_back({segments.substr(i, 1), "RES", "1", fmt::format("{}", i)});
        result.type.push_back(fmt::format("T{}", i));
        result.charge.push_back(0.1 * number);
        result.mass.push_back(1 + number);
        result.lines.push_back(10 + i);
    }
    result.bonds = {{0, 2}, {1, 4}, {5, 3}, {2, 3}, {6, 4}};
    result.angles = {{0, 2, 3}, {1, 4, 6}, {2, 3, 5}};
    result.dihedrals = {{5, 3, 2, 0}};
    result.impropers = {{3, 0, 2, 5}, {4, 1, 6, 0}};
    result.cmaps = {{0, 2, 3, 5, 2, 3, 5, 0}, {0, 1, 2, 3, 4, 5, 6, 0}};
    return result;
}

}  // namespace

TEST_CASE("a segment keeps the order of its atoms, and its terms follow them", "[molecule]") {
    Connectivity to;

    CHECK_FALSE(append_segment(two_segments(), "A", to));

    CHECK(to.file == "two.psf");
    REQUIRE(to.names.size() == 4);
    CHECK(to.names[1].atom == "2");
    CHECK(to.type == std::vector<std::string>{"T0", "T2", "T3", "T5"});
    CHECK(to.charge == std::vector<double>{0.0, 0.2, 0.1 * 3, 0.5});
    CHECK(to.mass == std::vector<double>{1, 3, 4, 6});
    CHECK(to.lines == std::vector<std::size_t>{10, 12, 13, 15});
    CHECK(to.bonds == std::vector<Pair>{{0, 1}, {3, 2}, {1, 2}});
    CHECK(to.angles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {1, 2, 3}});
    CHECK(to.dihedrals == std::vector<std::array<std::uint32_t, 4>>{{3, 2, 1, 0}});
    CHECK(to.impropers == std::vector<std::array<std::uint32_t, 4>>{{2, 0, 1, 3}});
    CHECK(to.cmaps == std::vector<std::array<std::uint32_t, 8>>{{0, 1, 2, 3, 1, 2, 3, 0}});
}

TEST_CASE("a second segment stands behind the first", "[molecule]") {
    Connectivity to;

    CHECK_FALSE(append_segment(two_segments(), "B", to));
    Connectivity other = two_segments();
    other.file = "other.psf";
    CHECK_FALSE(append_segment(other, "A", to));

    CHECK(to.file == "two.psf");
    CHECK(to.type == std::vector<std::string>{"T1", "T4", "T6", "T0", "T2", "T3", "T5"});
    CHECK(to.bonds == std::vector<Pair>{{0, 1}, {2, 1}, {3, 4}, {6, 5}, {4, 5}});
    CHECK(to.impropers == std::vector<std::array<std::uint32_t, 4>>{{5, 3, 4, 6}});
}

TEST_CASE("a bond that leads out of a segment is told and left out", "[molecule]") {
    Connectivity from = two_segments();
    from.bonds.push_back({6, 5});
    from.bonds.push_back({0, 1});
    Connectivity a, b, none;

    CHECK(append_segment(from, "A", a) == Pair{6, 5});
    CHECK(append_segment(from, "B", b) == Pair{6, 5});
    CHECK(a.bonds.size() == 3);
    CHECK(b.bonds.size() == 2);
    CHECK_FALSE(append_segment(from, "C", none));
    CHECK(none.names.empty());
    CHECK(none.bonds.empty());
}
