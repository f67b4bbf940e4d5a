#include "molecule/coincident_atoms.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <random>
#include <vector>

using namespace palpa;

namespace {

using Pairs = std::vector<std::array<std::size_t, 2>>;

// The definition, pair by pair.
Pairs find_slowly(const std::vector<Vec3>& positions, double distance) {
    Pairs pairs;
    std::vector<std::size_t> alone;
    for (std::size_t atom = 0; atom < positions.size(); ++atom) {
        bool is_alone = true;
        for (const std::size_t other : alone) {
            if ((positions[atom] - positions[other]).norm() >= distance) continue;
            pairs.push_back({other, atom});
            is_alone = false;
            break;
        }
        if (is_alone) alone.push_back(atom);
    }
    return pairs;
}

}  // namespace

TEST_CASE("atoms that coincide are found across the walls of cells", "[molecule]") {
    // In 1 Å^3 at 0.1 Å many pairs are near, about half of them in different cells.
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    const Vec3 centre = GENERATE(Vec3(0, 0, 0), Vec3(-1e5, 1e5, 12.3));
    std::vector<Vec3> positions;
    for (int i = 0; i < 400; ++i) {
        positions.push_back(centre + Vec3(uniform(random), uniform(random), uniform(random)));
    }

    const Pairs pairs = find_coincident_atoms(positions, 0.1);

    CHECK(pairs.size() > 50);
    CHECK(pairs == find_slowly(positions, 0.1));
}

TEST_CASE("atoms that are all in one place are each told once", "[molecule]") {
    const std::vector<Vec3> positions(60'000, Vec3(1, 2, 3));

    const Pairs pairs = find_coincident_atoms(positions, 0.1);

    REQUIRE(pairs.size() == 59'999);
    CHECK(pairs.back() == std::array<std::size_t, 2>{0, 59'999});
    CHECK(find_coincident_atoms(std::vector<Vec3>{{0, 0, 0}, {0, 0, 0.2}}, 0.1).empty());
}

TEST_CASE("atoms that coincide are told by name, the closest first", "[molecule]") {
    const std::vector<AtomName> names{{"A", "ALA", "1", "N"},
                                      {"A", "ALA", "1", "CA"},
                                      {"B", "GLY", "7", "N"},
                                      {"B", "GLY", "7", "CA"}};
    std::vector<Vec3> positions{{0, 0, 0}, {1.5, 0, 0}, {0.3, 0, 0}, {1.5, 0.12, 0}};

    CHECK(describe_coincident_atoms(names, positions, 0.5) ==
          "A ALA 1 CA and B GLY 7 CA are 0.12 Å apart, and 1 more such pairs");
    positions[2].y() = 1;
    CHECK(describe_coincident_atoms(names, positions, 0.5) ==
          "A ALA 1 CA and B GLY 7 CA are 0.12 Å apart");
    CHECK_FALSE(describe_coincident_atoms(names, positions, 0.1));
}
