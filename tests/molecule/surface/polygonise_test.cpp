#include "molecule/surface/polygonise.h"

#include "tests/support/closed_mesh.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <utility>

using namespace palpa;

namespace {

// Outside on all faces of the block, whatever is within.
BlockSamples random_samples(unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> number(-1, 1);
    BlockSamples samples;
    samples.fill(-1);
    for (int z = 1; z < block_cells; ++z)
        for (int y = 1; y < block_cells; ++y)
            for (int x = 1; x < block_cells; ++x) samples[point_index(x, y, z)] = number(engine);
    return samples;
}

std::array<double, 3> place_of(const LatticeCrossing& crossing) {
    std::array<double, 3> place{};
    for (std::size_t k = 0; k < 3; ++k) place[k] = crossing.point[k];
    place[static_cast<std::size_t>(crossing.axis)] += static_cast<double>(crossing.share);
    return place;
}

double volume_of(const LatticeSurface& surface) {
    double volume = 0;
    for (std::size_t i = 0; i < surface.indices.size(); i += 3) {
        const auto a = place_of(surface.vertices[surface.indices[i]]);
        const auto b = place_of(surface.vertices[surface.indices[i + 1]]);
        const auto c = place_of(surface.vertices[surface.indices[i + 2]]);
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) /
                  6;
    }
    return volume;
}

}  // namespace

TEST_CASE("whatever is inside, triangles close", "[molecule][surface]") {
    LatticeSurface surface;

    for (unsigned seed = 0; seed < 40; ++seed) {
        polygonise(random_samples(seed), surface);

        INFO("seed " << seed);
        REQUIRE(surface.indices.size() > 300);
        CHECK(test::count_mesh(surface.indices).is_closed);
        CHECK(volume_of(surface) > 0);
    }
}

TEST_CASE("one point inside is an octahedron", "[molecule][surface]") {
    BlockSamples samples;
    samples.fill(-1);
    samples[point_index(3, 4, 5)] = 3;
    LatticeSurface surface;

    polygonise(samples, surface);

    // Its corners are at 3/4 of the way to the six neighbours: the volume is 4/3 (3/4)^3.
    CHECK(surface.vertices.size() == 6);
    CHECK(surface.indices.size() == 24);
    CHECK(test::count_mesh(surface.indices).euler == 2);
    CHECK(volume_of(surface) == Approx(4.0 / 3 * std::pow(0.75, 3)).epsilon(1e-6));
}

TEST_CASE("a point outside in the midst of all others is a hole, seen from within",
          "[molecule][surface]") {
    BlockSamples samples;
    samples.fill(1);
    samples[point_index(3, 4, 5)] = -3;
    LatticeSurface surface;

    polygonise(samples, surface);

    CHECK(test::count_mesh(surface.indices).is_closed);
    CHECK(volume_of(surface) == Approx(-4.0 / 3 * std::pow(0.75, 3)).epsilon(1e-6));
}

TEST_CASE("two blocks cut their common face in the same places", "[molecule][surface]") {
    // Random also on the faces, and the upper face of one is the lower face of the other.
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> number(-1, 1);
    BlockSamples lower, upper;
    for (float& sample : lower) sample = number(engine);
    for (float& sample : upper) sample = number(engine);
    for (int y = 0; y < block_points; ++y)
        for (int x = 0; x < block_points; ++x)
            upper[point_index(x, y, 0)] = lower[point_index(x, y, block_cells)];
    LatticeSurface below, above;
    polygonise(lower, below);
    polygonise(upper, above);

    // Edges of triangles within the face: each of one block's is the other's, turned round.
    using Corner = std::array<double, 3>;
    const auto edges_in = [](const LatticeSurface& surface, int z) {
        std::map<std::pair<Corner, Corner>, int> edges;
        for (std::size_t i = 0; i < surface.indices.size(); ++i) {
            const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
            const LatticeCrossing& a = surface.vertices[surface.indices[i]];
            const LatticeCrossing& b = surface.vertices[surface.indices[next]];
            if (a.point[2] != z || b.point[2] != z || a.axis == 2 || b.axis == 2) continue;
            Corner from = place_of(a), to = place_of(b);
            from[2] = to[2] = 0;
            ++edges[{from, to}];
        }
        return edges;
    };
    const auto edges_below = edges_in(below, block_cells), edges_above = edges_in(above, 0);

    REQUIRE(edges_below.size() > 40);
    CHECK(edges_below.size() == edges_above.size());
    for (const auto& [edge, times] : edges_below) {
        CHECK(times == 1);
        CHECK(edges_above.contains({edge.second, edge.first}));
    }
}
