#include "field/cluster_list.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

// How often each pair of atoms, lower index first, stands in the list.
std::map<Pair, int> count_pairs(const ClusterList& list) {
    std::map<Pair, int> count;
    const auto add = [&](std::size_t row_cluster, std::uint32_t cluster, std::uint64_t pairs) {
        for (std::size_t bit = 0; bit < 64; ++bit) {
            if (!(pairs >> bit & 1)) continue;
            const std::uint32_t a = list.atoms[row_cluster * cluster_size + bit / 8];
            const std::uint32_t b = list.atoms[cluster * cluster_size + bit % 8];
            if (a != no_atom && b != no_atom) ++count[std::minmax(a, b)];
        }
    };
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        for (std::size_t t = list.first_plain[c]; t < list.first_plain[c + 1]; ++t) {
            for (std::uint32_t row = 0; row < 8; ++row) {
                if (list.plain[t].rows >> row & 1)
                    add(c, list.plain[t].cluster, std::uint64_t{0xff} << (8 * row));
            }
        }
        for (std::size_t t = list.first_masked[c]; t < list.first_masked[c + 1]; ++t)
            add(c, list.masked[t].cluster, list.masked[t].pairs);
    }
    return count;
}

std::vector<Vec3> random_places(std::size_t count, double spread) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-spread, spread);
    std::vector<Vec3> places;
    while (places.size() < count) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        places.emplace_back(x, y, z);
    }
    return places;
}

// A chain, each atom with the three after it; some the other way round.
std::vector<std::array<std::uint32_t, 2>> chain_exclusions(std::uint32_t count) {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t j = i + 1; j < count && j <= i + 3; ++j) {
            if ((i + j) % 2 == 0) {
                pairs.push_back({j, i});
            } else {
                pairs.push_back({i, j});
            }
        }
    }
    return pairs;
}

}  // namespace

TEST_CASE("a full list has every pair once but for those left out", "[field][cluster]") {
    const auto atoms = static_cast<std::uint32_t>(GENERATE(0, 1, 7, 8, 9, 16, 61));
    INFO(atoms << " atoms");

    const auto count = count_pairs(build_full_cluster_list(atoms, chain_exclusions(atoms)));

    std::size_t expected = 0;
    for (std::uint32_t i = 0; i < atoms; ++i) {
        for (std::uint32_t j = i + 4; j < atoms; ++j, ++expected) {
            REQUIRE(count.contains({i, j}));
            CHECK(count.at({i, j}) == 1);
        }
    }
    CHECK(count.size() == expected);
}

TEST_CASE("tiles of one group are left out, pairs between groups never", "[field][cluster]") {
    constexpr std::uint32_t atoms = 120;
    // Two groups shuffled among each other, and some of one atom each.
    std::vector<std::uint32_t> groups;
    for (std::uint32_t i = 0; i < atoms; ++i) groups.push_back(i % 3 == 2 ? 100 + i : i % 3);

    const auto count = count_pairs(build_full_cluster_list(atoms, chain_exclusions(atoms), groups));

    std::size_t within = 0, left_out = 0;
    for (std::uint32_t i = 0; i < atoms; ++i) {
        for (std::uint32_t j = i + 4; j < atoms; ++j) {
            const auto found = count.find({i, j});
            const int times = found == count.end() ? 0 : found->second;
            if (groups[i] != groups[j]) REQUIRE(times == 1);
            CHECK(times <= 1);
            if (groups[i] == groups[j]) ++within;
            if (times == 0) ++left_out;
        }
    }
    CHECK(left_out <= within);
    CHECK(left_out > within / 2);
}

TEST_CASE("the pairs of a list are those of its tiles", "[field][cluster]") {
    const std::vector<Vec3> places = random_places(77, 8);
    const ClusterList list = build_cluster_list(places, chain_exclusions(77), 6, 1);

    std::map<std::pair<std::uint32_t, std::uint32_t>, int> listed;
    for (const auto& [a, b] : list_pairs(list)) ++listed[std::minmax(a, b)];

    const auto count = count_pairs(list);
    CHECK(listed.size() == count.size());
    for (const auto& [pair, times] : count) CHECK(listed[pair] == times);
}

TEST_CASE("a list with a cutoff has every near pair once and none left out", "[field][cluster]") {
    constexpr std::uint32_t atoms = 333;
    const std::vector<Vec3> places = random_places(atoms, 12);

    const ClusterList list = build_cluster_list(places, chain_exclusions(atoms), 6, 1);

    const auto count = count_pairs(list);
    for (std::uint32_t i = 0; i < atoms; ++i) {
        for (std::uint32_t j = i + 1; j < atoms; ++j) {
            const auto found = count.find({i, j});
            const int times = found == count.end() ? 0 : found->second;
            const bool is_near = (places[i] - places[j]).norm() < 7;
            if (j <= i + 3) CHECK(times == 0);
            if (j > i + 3 && is_near) CHECK(times == 1);
            CHECK(times <= 1);
        }
    }
    // Far pairs that stand beside near ones in a row are not many.
    CHECK(static_cast<double>(count.size()) < 0.6 * atoms * (atoms - 1) / 2);
}

TEST_CASE("a list is outdated when an atom has moved half the skin, a full one never",
          "[field][cluster]") {
    std::vector<Vec3> places = random_places(40, 5);
    const ClusterList list = build_cluster_list(places, {}, 6, 1);
    const ClusterList full = build_full_cluster_list(40, {});

    CHECK_FALSE(is_outdated(list, places));
    places[17].y() += 0.49;
    CHECK_FALSE(is_outdated(list, places));
    places[17].y() += 0.02;
    CHECK(is_outdated(list, places));
    places[17].y() = std::numeric_limits<double>::quiet_NaN();
    CHECK(is_outdated(list, places));
    CHECK_FALSE(is_outdated(full, places));
}

TEST_CASE("an atom that is nowhere has no neighbours", "[field][cluster]") {
    std::vector<Vec3> places = random_places(30, 3);
    places[11].x() = std::numeric_limits<double>::quiet_NaN();
    places[12].z() = std::numeric_limits<double>::infinity();

    const auto count = count_pairs(build_cluster_list(places, {}, 20, 1));

    for (std::uint32_t i = 0; i < 30; ++i) {
        for (std::uint32_t j = i + 1; j < 30; ++j) {
            const bool nowhere = i == 11 || i == 12 || j == 11 || j == 12;
            if (!nowhere) CHECK(count.contains({i, j}));
        }
    }
}
