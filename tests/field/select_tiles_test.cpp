#include "field/select_tiles.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <iterator>
#include <random>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

using AtomPair = std::array<std::uint32_t, 2>;

std::vector<AtomPair> sorted_pairs(const ClusterList& list) {
    std::vector<AtomPair> pairs = list_pairs(list);
    for (auto& [a, b] : pairs) {
        if (a > b) std::swap(a, b);
    }
    std::ranges::sort(pairs);
    return pairs;
}

}  // namespace

TEST_CASE("selected tiles hold each near pair of two groups once", "[field][list]") {
    const std::uint32_t count = GENERATE(3U, 8U, 61U, 200U);
    const int group_count = GENERATE(1, 2, 9, 50);
    const bool ends = GENERATE(false, true);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-8, 8);
    std::vector<Vec3> places;
    std::vector<std::uint32_t> groups;
    std::vector<AtomPair> left_out;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double x = place(random), y = place(random), z = place(random);
        places.emplace_back(x, y, z);
        // Mostly one large group, as a molecule at rest is.
        const bool is_rest = random() % 3 != 0;
        groups.push_back(is_rest ? 0 : static_cast<std::uint32_t>(random() % group_count));
        if (i > 0 && i % 4 != 0) left_out.push_back({i - 1, i});
    }
    const ClusterList whole = ends ? build_cluster_list(places, left_out, 5, 1)
                                   : build_full_cluster_list(count, left_out);

    // Since then all have moved a little.
    const double skin = GENERATE(0.2, 1.0);
    for (Vec3& at : places) at += 0.02 * Vec3(place(random), place(random), place(random));

    const ClusterList selected = select_tiles(whole, groups, places, skin);

    const std::vector<AtomPair> all = sorted_pairs(whole), found = sorted_pairs(selected);
    CHECK(std::ranges::adjacent_find(found) == found.end());
    CHECK(std::ranges::includes(sorted_pairs(build_full_cluster_list(count, left_out)), found));
    std::vector<AtomPair> left;
    std::ranges::set_difference(all, found, std::back_inserter(left));
    CHECK(std::ranges::all_of(left, [&](const AtomPair& p) {
        return groups[p[0]] == groups[p[1]] ||
               (ends && (places[p[0]] - places[p[1]]).norm() >= 5 + skin);
    }));
    if (group_count == 1) CHECK(selected.clusters() == 0);
    if (ends && count == 200) CHECK(found.size() < all.size());
    const std::vector<AtomPair> of_all_groups = sorted_pairs(select_tiles(whole, {}, places, skin));
    std::erase_if(left, [&](const AtomPair& p) {
        return (places[p[0]] - places[p[1]]).norm() >= 5 + skin && ends;
    });
    CHECK(std::ranges::includes(of_all_groups, left));
    CHECK(selected.positions.empty());
}
