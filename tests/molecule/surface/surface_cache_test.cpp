#include "molecule/surface/surface_cache.h"

#include "tests/support/closed_mesh.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <stdexcept>
#include <tuple>
#include <vector>

using namespace palpa;

namespace {

struct Cloud {
    std::vector<Vec3> places;
    std::vector<double> radii;
};

// Atoms about as dense as a protein's.
Cloud make_cloud(int count, double half_edge, unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> place(-half_edge, half_edge), size(1.2, 1.8);
    Cloud cloud;
    for (int i = 0; i < count; ++i) {
        cloud.places.emplace_back(place(engine), place(engine), place(engine));
        cloud.radii.push_back(size(engine));
    }
    return cloud;
}

// What all vertices of all blocks say, whatever their order.
using Vertex = std::array<double, 7>;
std::multiset<Vertex> vertices_of(const SurfaceCache& cache) {
    std::multiset<Vertex> all;
    for (const auto& [index, block] : cache.blocks())
        for (std::size_t i = 0; i < block.mesh.places.size(); ++i) {
            const auto p = block.mesh.places[i].cast<double>();
            const auto n = block.mesh.normals[i].cast<double>();
            all.insert({p.x(), p.y(), p.z(), n.x(), n.y(), n.z(),
                        static_cast<double>(block.mesh.atoms[i])});
        }
    return all;
}

void move_near(std::vector<Vec3>& places, const Vec3& near, double distance, double by) {
    std::mt19937 engine(11);
    std::normal_distribution<double> step(0, by);
    for (Vec3& place : places)
        if ((place - near).norm() < distance)
            place += Vec3(step(engine), step(engine), step(engine));
}

SurfaceMesh gaussian_of(const std::vector<Vec3>& places, double radius, double spacing) {
    return build_surface(places, std::vector<double>(places.size(), radius), {.spacing = spacing});
}

}  // namespace

TEST_CASE("a lone atom's Gaussian surface is its sphere", "[molecule][surface]") {
    const double r = 1.7, pi = std::numbers::pi;
    double error = 0;
    for (const double spacing : {0.8, 0.4, 0.2}) {
        const SurfaceMesh mesh = gaussian_of({{0.3, -0.2, 0.1}}, r, spacing);

        const double volume = find_volume(mesh), exact = 4 * pi / 3 * r * r * r;
        CHECK(volume == Approx(exact).epsilon(0.35 * spacing * spacing));
        CHECK(find_area(mesh) == Approx(4 * pi * r * r).epsilon(0.2 * spacing * spacing));
        if (error > 0) CHECK(exact - volume < error / 3);
        error = exact - volume;
        for (std::size_t i = 0; i < mesh.places.size(); ++i) {
            const Vec3 out = mesh.places[i].cast<double>() - Vec3(0.3, -0.2, 0.1);
            CHECK(out.norm() == Approx(r).margin(0.01 * spacing));
            CHECK((out.normalized() - mesh.normals[i].cast<double>()).norm() < 1e-5);
        }
    }
}

TEST_CASE("between two equal atoms the Gaussian surface is where their sum is 1",
          "[molecule][surface]") {
    const double r = 1.7, d = 2.4, sharpness = 1.5;
    const SurfaceMesh mesh = gaussian_of({{0, 0, 0}, {d, 0, 0}}, r, 0.25);

    // In the middle plane both terms are one half.
    const double squared = r * r * (1 + std::log(2) / sharpness);
    const double middle = std::sqrt(squared - d * d / 4);
    double nearest = 1e9, height = 0;
    for (const Eigen::Vector3f& place : mesh.places) {
        const double away = std::abs(static_cast<double>(place.x()) - d / 2);
        if (away >= nearest) continue;
        nearest = away;
        height = std::hypot(static_cast<double>(place.y()), static_cast<double>(place.z()));
    }
    CHECK(height == Approx(middle).margin(0.01));
    for (std::size_t i = 0; i < mesh.places.size(); ++i)
        if (std::abs(mesh.places[i].x() - 1.2F) > 1e-4F)
            CHECK(mesh.atoms[i] == (mesh.places[i].x() < 1.2F ? 0U : 1U));
}

TEST_CASE("a ball, a ring and two balls have their Euler characteristics", "[molecule][surface]") {
    const auto kind = GENERATE(SurfaceKind::Gaussian, SurfaceKind::Excluded);
    std::vector<Vec3> ring;
    for (int i = 0; i < 12; ++i) {
        const double angle = std::numbers::pi * i / 6;
        ring.emplace_back(7 * std::cos(angle), 7 * std::sin(angle), 0.3 * i / 12);
    }
    const auto euler_of = [&](const std::vector<Vec3>& places) {
        const SurfaceMesh mesh = build_surface(places, std::vector<double>(places.size(), 1.9),
                                               {.kind = kind, .spacing = 0.5});
        const test::MeshCount count = test::count_mesh(mesh.indices);
        CHECK(count.is_closed);
        return count.euler;
    };

    CHECK(euler_of({{0, 0, 0}}) == 2);
    CHECK(euler_of(ring) == 0);
    CHECK(euler_of({{0, 0, 0}, {20, 0, 0}}) == 4);
}

TEST_CASE("a local remake equals the whole one, vertex for vertex", "[molecule][surface]") {
    const auto kind = GENERATE(SurfaceKind::Gaussian, SurfaceKind::Excluded);
    const Cloud cloud = make_cloud(700, 10, 5);
    const SurfaceSettings settings{.kind = kind, .spacing = 0.9};
    SurfaceCache cache(cloud.radii, settings);
    cache.update(cloud.places);
    const std::size_t blocks = cache.blocks().size();
    const auto before = vertices_of(cache);

    std::vector<Vec3> places = cloud.places;
    move_near(places, {8, 8, 8}, 5, 0.4);
    places[0] += Vec3(40, 0, 0);  // one flies away, one comes to where nothing was
    const SurfaceUpdate update = cache.update(places);
    SurfaceCache whole(cloud.radii, settings);
    whole.update(places);

    CHECK(vertices_of(cache) != before);
    CHECK(vertices_of(cache) == vertices_of(whole));
    CHECK(update.changed.size() < 2 * blocks / 3);
    CHECK(update.waiting == 0);
    CHECK(test::count_mesh(join_blocks(cache).indices).is_closed);

    // And back again.
    cache.update(cloud.places);
    CHECK(vertices_of(cache) == before);
    CHECK(cache.update(cloud.places).changed.empty());
}

TEST_CASE("at a cloud's Gaussian surface the sum over all atoms is 1", "[molecule][surface]") {
    const Cloud cloud = make_cloud(200, 7, 12);
    const double sharpness = GENERATE(0.8, 1.5, 3.0);

    const SurfaceMesh mesh =
        build_surface(cloud.places, cloud.radii, {.spacing = 0.6, .sharpness = sharpness});

    REQUIRE(mesh.places.size() > 500);
    double square = 0;
    std::size_t turned = 0;
    for (std::size_t v = 0; v < mesh.places.size(); ++v) {
        const Vec3 at = mesh.places[v].cast<double>();
        double sum = 0, gap = 1e9;
        Vec3 inward = Vec3::Zero();
        for (std::size_t i = 0; i < cloud.places.size(); ++i) {
            const double size = cloud.radii[i] * cloud.radii[i];
            const Vec3 away = at - cloud.places[i];
            const double term = std::exp(sharpness * (1 - away.squaredNorm() / size));
            sum += term;
            inward -= term / size * away;
            gap = std::min(gap, away.norm() - cloud.radii[i]);
        }
        square += (sum - 1) * (sum - 1);
        turned += (inward.normalized() + mesh.normals[v].cast<double>()).norm() > 0.1 ? 1 : 0;
        const std::size_t atom = mesh.atoms[v];
        CHECK((at - cloud.places[atom]).norm() - cloud.radii[atom] ==
              Approx(gap).margin(0.3));  // twice a step to the surface
    }
    CHECK(turned < mesh.places.size() / 200);
    // Tens of terms below e^-7 = 0.0009 are omitted.
    CHECK(std::sqrt(square / static_cast<double>(mesh.places.size())) < 0.02);
}

TEST_CASE("one atom's move changes all blocks that it has to", "[molecule][surface]") {
    const auto kind = GENERATE(SurfaceKind::Gaussian, SurfaceKind::Excluded);
    const SurfaceSettings settings{.kind = kind, .spacing = 0.6};
    const Cloud cloud = make_cloud(120, 6, 13);
    std::vector<Vec3> places = cloud.places;
    SurfaceCache cache(cloud.radii, settings);
    cache.update(places);
    std::mt19937 engine(14);
    std::normal_distribution<double> step(0, 0.5);

    for (std::size_t atom = 0; atom < places.size(); atom += 3) {
        places[atom] += Vec3(step(engine), step(engine), step(engine));
        cache.update(places);
        SurfaceCache whole(cloud.radii, settings);
        whole.update(places);

        INFO("atom " << atom);
        CHECK(vertices_of(cache) == vertices_of(whole));
    }
}

TEST_CASE("blocks that do not change are not listed", "[molecule][surface]") {
    const Cloud cloud = make_cloud(700, 10, 6);
    SurfaceCache cache(cloud.radii, {});
    cache.update(cloud.places);
    const auto before = cache.blocks();

    std::vector<Vec3> places = cloud.places;
    move_near(places, {-8, -8, -8}, 4, 0.3);
    const SurfaceUpdate update = cache.update(places);

    const std::set<BlockIndex> listed(update.changed.begin(), update.changed.end());
    REQUIRE(!listed.empty());
    for (const auto& [index, block] : before) {
        if (listed.contains(index)) continue;
        REQUIRE(cache.blocks().contains(index));
        CHECK(cache.blocks().at(index).mesh.places == block.mesh.places);
        CHECK(cache.blocks().at(index).mesh.normals == block.mesh.normals);
    }
}

TEST_CASE("moves within the tolerance wait until they add up to more", "[molecule][surface]") {
    const Cloud cloud = make_cloud(50, 4, 7);
    SurfaceCache cache(cloud.radii, {.tolerance = 0.1});
    cache.update(cloud.places);
    std::vector<Vec3> places = cloud.places;

    places[3].x() += 0.06;
    CHECK(cache.update(places).changed.empty());
    CHECK(cache.positions()[3] == cloud.places[3]);
    places[3].x() += 0.06;
    CHECK(!cache.update(places).changed.empty());
    CHECK(cache.positions()[3] == places[3]);
}

TEST_CASE(
    "with a budget the surface is closed after each call, near the hand first, and in the end "
    "the whole one",
    "[molecule][surface]") {
    const auto kind = GENERATE(SurfaceKind::Gaussian, SurfaceKind::Excluded);
    const Cloud cloud = make_cloud(400, 8, 8);
    const SurfaceSettings settings{.kind = kind};
    SurfaceCache cache(cloud.radii, settings);
    cache.update(cloud.places);
    std::vector<Vec3> places = cloud.places;
    move_near(places, {0, 0, 0}, 100, 0.3);
    const SurfaceBudget budget{.blocks = 30, .near = {8, 8, 8}};

    std::size_t calls = 0, waiting = 1;
    double nearest_waiting = 0;
    while (waiting > 0 && calls < 200) {
        const SurfaceUpdate update = cache.update(places, budget);
        ++calls;
        CHECK(update.changed.size() <= budget.blocks);
        waiting = update.waiting;
        CHECK(test::count_mesh(join_blocks(cache).indices).is_closed);
        if (calls == 1) {
            double nearest = 1e9, nearest_done = 1e9;
            for (std::size_t i = 0; i < places.size(); ++i) {
                double& least = cache.positions()[i] == places[i] ? nearest_done : nearest;
                least = std::min(least, (places[i] - budget.near).norm());
            }
            CHECK(nearest_done < nearest);
            nearest_waiting = nearest;
        }
    }
    SurfaceCache whole(cloud.radii, settings);
    whole.update(places);

    CHECK(nearest_waiting > 2);
    CHECK(calls > 3);
    CHECK(waiting == 0);
    CHECK(vertices_of(cache) == vertices_of(whole));
}

TEST_CASE("atoms that never stand still near the hand do not keep far ones waiting for ever",
          "[molecule][surface]") {
    const Cloud cloud = make_cloud(500, 9, 9);
    SurfaceCache cache(cloud.radii, {});
    cache.update(cloud.places);
    std::vector<Vec3> places = cloud.places;
    std::size_t far = 0;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].sum() < places[far].sum()) far = i;
    places[far] += Vec3(0.5, 0, 0);

    int calls = 0;
    while (cache.positions()[far] != places[far] && calls < 200) {
        for (std::size_t i = 0; i < places.size(); ++i)
            if ((places[i] - Vec3(9, 9, 9)).norm() < 10) places[i].x() += calls % 2 ? 0.2 : -0.2;
        cache.update(places, SurfaceBudget{.blocks = 30, .near = {8, 8, 8}});
        ++calls;
    }

    CHECK(calls > 1);
    CHECK(calls < 60);
}

TEST_CASE("atoms without a radius or a place have no part in the surface", "[molecule][surface]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Vec3> places{{0, 0, 0}, {1.5, 0, 0}, {nan, 0, 0}, {1e300, 0, 0}};

    SurfaceCache cache({1.7, 0, 1.7, 1.7}, {.spacing = 0.5});
    cache.update(places);
    SurfaceCache alone({1.7}, {.spacing = 0.5});
    alone.update(std::vector<Vec3>{{0, 0, 0}});

    CHECK(vertices_of(cache) == vertices_of(alone));
    // It comes back, and goes again.
    std::vector<Vec3> back = places;
    back[2] = {6, 0, 0};
    cache.update(back);
    CHECK(test::count_mesh(join_blocks(cache).indices).euler == 4);
    cache.update(places);
    CHECK(vertices_of(cache) == vertices_of(alone));
    CHECK(build_surface({}, {}, {}).indices.empty());
}

TEST_CASE("settings that make no surface are refused", "[molecule][surface]") {
    CHECK_THROWS_AS(SurfaceCache({1.0}, {.spacing = 0}), std::invalid_argument);
    CHECK_THROWS_AS(SurfaceCache({1.0}, {.sharpness = -1}), std::invalid_argument);
    CHECK_THROWS_AS(SurfaceCache({1.0}, {.probe = -0.1}), std::invalid_argument);
    CHECK_THROWS_AS(SurfaceCache({1.0}, {.tolerance = std::nan("")}), std::invalid_argument);
}
