#include "field/cluster_list.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
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

namespace {

constexpr double test_cutoff = 6, test_skin = 1;

// Every pair nearer than the cutoff and what its atoms have left of the skin stands in the list
// once, no pair left out and none twice.
void check_pairs(const ClusterList& list, const std::vector<Vec3>& places) {
    const std::size_t n = places.size();
    std::vector<int> count(n * n);
    for (const auto& [a, b] : list_pairs(list)) ++count[std::min(a, b) * n + std::max(a, b)];
    const auto moved = [&](std::uint32_t i) { return (places[i] - list.positions[i]).norm(); };
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = i + 1; j < n; ++j) {
            const int times = count[i * n + j];
            const double reach = test_cutoff + test_skin - moved(i) - moved(j);
            if (j <= i + 3 && times != 0) FAIL("left out: " << i << ' ' << j);
            if (j > i + 3 && times != 1 && (places[i] - places[j]).norm() < reach - 1e-9)
                FAIL("missing: " << i << ' ' << j);
            if (times > 1) FAIL("more than once: " << i << ' ' << j);
        }
    }
}

// Tiles in order, even in number, the rest of each cluster's room at its end.
void check_layout(const ClusterList& list) {
    REQUIRE(list.first_plain.size() == list.clusters() + 1);
    REQUIRE(list.first_masked.size() == list.clusters() + 1);
    CHECK(list.first_plain.back() == list.plain.size());
    CHECK(list.first_masked.back() == list.masked.size());
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        CHECK(list.first_plain[c] % 2 == 0);
        CHECK(list.first_masked[c] % 2 == 0);
        bool sorted = true;
        for (std::size_t t = list.first_plain[c] + 1; t < list.first_plain[c + 1]; ++t) {
            const ClusterTile &a = list.plain[t - 1], &b = list.plain[t];
            sorted = sorted && (a.rows == b.rows ? a.cluster <= b.cluster : a.rows > b.rows);
            if (b.rows == 0) sorted = sorted && b.cluster == list.clusters();
        }
        for (std::size_t t = list.first_masked[c] + 1; t < list.first_masked[c + 1]; ++t) {
            const MaskedTile &a = list.masked[t - 1], &b = list.masked[t];
            sorted = sorted && (b.pairs == 0 ? b.cluster == list.clusters()
                                             : a.pairs != 0 && a.cluster < b.cluster);
        }
        CHECK(sorted);
    }
}

bool is_same(const ClusterList& a, const ClusterList& b) {
    const auto same_plain = [](const ClusterTile& s, const ClusterTile& t) {
        return s.cluster == t.cluster && s.rows == t.rows;
    };
    const auto same_masked = [](const MaskedTile& s, const MaskedTile& t) {
        return s.cluster == t.cluster && s.pairs == t.pairs;
    };
    return a.atoms == b.atoms && a.positions == b.positions && a.first_plain == b.first_plain &&
           a.first_masked == b.first_masked &&
           std::equal(a.plain.begin(), a.plain.end(), b.plain.begin(), b.plain.end(), same_plain) &&
           std::equal(a.masked.begin(), a.masked.end(), b.masked.begin(), b.masked.end(),
                      same_masked);
}

// Atoms that go as one rigid body.
struct Group {
    std::vector<std::uint32_t> atoms;
    Vec3 step;
};

void step_group(const Group& group, std::mt19937& random, std::vector<Vec3>& places) {
    std::normal_distribution<double> normal(0, 0.05);
    const double x = normal(random), y = normal(random), z = normal(random);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(normal(random), Vec3(y, z, x).normalized()));
    Vec3 centre = Vec3::Zero();
    for (const std::uint32_t atom : group.atoms)
        centre += places[atom] / static_cast<double>(group.atoms.size());
    for (const std::uint32_t atom : group.atoms) {
        places[atom] = centre + turn * (places[atom] - centre) + group.step + Vec3(x, y, z);
    }
}

}  // namespace

TEST_CASE("an updated list has every near pair, whatever groups move", "[field][cluster]") {
    constexpr std::uint32_t atoms = 500;
    const bool tells_moved = GENERATE(false, true);
    const auto share = static_cast<std::uint32_t>(GENERATE(1, 5, 30, 100));  // percent
    INFO(share << " % move, " << (tells_moved ? "told" : "not told"));
    std::vector<Vec3> places = random_places(atoms, 12);
    std::mt19937 random(share);
    // Neighbours, as bodies of a molecule are, and one atom here and there.
    std::vector<std::uint32_t> order(atoms);
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return places[a].x() < places[b].x(); });
    std::vector<Group> groups{{{}, Vec3(0.1, 0.05, 0)}, {{}, Vec3(-0.08, 0, 0.05)}};
    for (std::uint32_t i = 0; i < atoms * share / 100; ++i)
        groups[i % 5 == 0 ? 1 : 0].atoms.push_back(order[i]);
    std::vector<std::uint32_t> moved = groups[0].atoms;
    moved.insert(moved.end(), groups[1].atoms.begin(), groups[1].atoms.end());
    const auto left_out = chain_exclusions(atoms);
    ClusterList list = build_cluster_list(places, left_out, test_cutoff, test_skin);
    std::map<ListChange, int> changes;

    for (int step = 0; step < 40; ++step) {
        for (const Group& group : groups) step_group(group, random, places);
        const std::vector<std::uint32_t> composition = list.atoms;
        const ListChange change = tells_moved ? update_cluster_list(places, left_out, moved, list)
                                              : update_cluster_list(places, left_out, list);
        ++changes[change];
        REQUIRE_FALSE(is_outdated(list, places));
        if (change != ListChange::Clusters) REQUIRE(list.atoms == composition);
        check_pairs(list, places);
        check_layout(list);
    }

    CHECK(changes[ListChange::None] > 0);
    CHECK(changes[ListChange::Tiles] + changes[ListChange::Clusters] > 5);
    if (share <= 30) CHECK(changes[ListChange::Tiles] > 5);
    if (share == 100) CHECK(changes[ListChange::Clusters] > 5);
}

TEST_CASE("an update of nothing changes nothing", "[field][cluster]") {
    std::vector<Vec3> places = random_places(200, 9);
    const auto left_out = chain_exclusions(200);
    ClusterList list = build_cluster_list(places, left_out, test_cutoff, test_skin);
    const ClusterList before = list;

    places[31].x() += 0.49;
    CHECK(update_cluster_list(places, left_out, list) == ListChange::None);
    CHECK(update_cluster_list(places, left_out, std::vector<std::uint32_t>{31, 5}, list) ==
          ListChange::None);
    CHECK(update_cluster_list(places, left_out, std::vector<std::uint32_t>{}, list) ==
          ListChange::None);
    CHECK(is_same(list, before));
    ClusterList full = build_full_cluster_list(200, left_out);
    places[31].x() += 9;
    CHECK(update_cluster_list(places, left_out, full) == ListChange::None);
}

TEST_CASE("there and back by updates is the list as it was", "[field][cluster]") {
    std::vector<Vec3> places = random_places(400, 11);
    const auto left_out = chain_exclusions(400);
    ClusterList list = build_cluster_list(places, left_out, test_cutoff, test_skin);
    const auto pairs = count_pairs(list);
    const std::vector<Vec3> home = places;
    const std::vector<std::uint32_t> moved{17, 18, 19, 80, 81, 17};

    for (const std::uint32_t atom : {17U, 18U, 19U, 80U, 81U}) places[atom].z() += 3;
    REQUIRE(update_cluster_list(places, left_out, moved, list) == ListChange::Tiles);
    CHECK(count_pairs(list) != pairs);
    REQUIRE(update_cluster_list(home, left_out, moved, list) == ListChange::Tiles);

    CHECK(count_pairs(list) == pairs);
    CHECK(list.positions == home);
    CHECK(list.memory.rows == list.memory.rows_at_build);
}

TEST_CASE("clusters that have become wide are built anew", "[field][cluster]") {
    constexpr std::uint32_t atoms = 600;
    std::vector<Vec3> places = random_places(atoms, 14);
    const auto left_out = chain_exclusions(atoms);
    ClusterList list = build_cluster_list(places, left_out, test_cutoff, test_skin);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-14, 14);
    std::size_t updates = 0;

    // Atoms jump anywhere, few at a time: soon no cluster is one.
    ListChange change = ListChange::None;
    while (change != ListChange::Clusters && updates < 100) {
        const auto atom = static_cast<std::uint32_t>(random() % atoms);
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        places[atom] = Vec3(x, y, z);
        change = update_cluster_list(places, left_out, std::vector<std::uint32_t>{atom}, list);
        check_pairs(list, places);
        ++updates;
    }

    CHECK(updates > 3);
    CHECK(updates < 100);
    CHECK(is_same(list, build_cluster_list(places, left_out, test_cutoff, test_skin)));
}

TEST_CASE("an atom that was nowhere has neighbours once it is somewhere", "[field][cluster]") {
    std::vector<Vec3> places = random_places(300, 9);
    const auto left_out = chain_exclusions(300);
    ClusterList list = build_cluster_list(places, left_out, test_cutoff, test_skin);
    const Vec3 home = places[40];

    places[40].x() = std::numeric_limits<double>::quiet_NaN();
    CHECK(update_cluster_list(places, left_out, list) == ListChange::Tiles);
    places[40] = home;
    CHECK(update_cluster_list(places, left_out, list) == ListChange::Tiles);

    check_pairs(list, places);
}
