#include "molecule/surface/potential.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

using namespace palpa;

namespace {

// Bjerrum's length of vacuum at 300 K: e^2/(4 pi epsilon_0 k T) with CODATA's e = 1.602176634e-19
// C, epsilon_0 = 8.8541878128e-12 F/m and k = 1.380649e-23 J/K is 556.99 Å. CHARMM's constant is
// 6e-5 smaller.
constexpr double bjerrum = 557.0;

SurfaceMesh point_at(const Eigen::Vector3f& place, const Eigen::Vector3f& normal) {
    return {.places = {place}, .normals = {normal}, .atoms = {0}, .indices = {}};
}

}  // namespace

TEST_CASE("a charge's potential falls with the distance, or with its square",
          "[molecule][surface]") {
    const SurfaceMesh mesh = point_at({3, 0, 0}, {1, 0, 0});
    const std::vector<Vec3> positions{{0, 0, 0}};
    const std::vector<double> charges{1};

    // At 3 + 1.4 Å.
    const std::vector<float> growing = find_potentials(mesh, positions, charges);
    const std::vector<float> water = find_potentials(
        mesh, positions, charges, {.dielectric = {.constant = 80, .grows_with_distance = false}});
    const std::vector<float> cold =
        find_potentials(mesh, positions, charges, {.outward = 0, .temperature = 150});

    CHECK(growing.at(0) == Approx(bjerrum / (4 * 4.4 * 4.4)).epsilon(2e-4));
    CHECK(water.at(0) == Approx(bjerrum / (80 * 4.4)).epsilon(2e-4));
    CHECK(cold.at(0) == Approx(2 * bjerrum / (4 * 9)).epsilon(2e-4));
}

TEST_CASE("potentials of two charges add up", "[molecule][surface]") {
    const SurfaceMesh mesh = point_at({0, 3, 0}, {0, 1, 0});
    const std::vector<Vec3> positions{{0, 0, 0}, {2, 0, 0}};
    const PotentialSettings water{.dielectric = {.constant = 80, .grows_with_distance = false}};

    const float sum = find_potentials(mesh, positions, std::vector<double>{1, -0.5}, water).at(0);
    const float dipole = find_potentials(point_at({1, 3, 0}, {0, 1, 0}), positions,
                                         std::vector<double>{1, -1}, water)
                             .at(0);

    CHECK(sum == Approx(bjerrum / 80 * (1 / 4.4 - 0.5 / std::sqrt(4.4 * 4.4 + 4))).epsilon(2e-4));
    CHECK(dipole == Approx(0).margin(1e-6));
}

TEST_CASE("many potentials, far from the origin, are the sums in double", "[molecule][surface]") {
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> place(-12, 12), charge(-1, 1);
    const Vec3 far(1000, -2000, 500);
    std::vector<Vec3> positions;
    std::vector<double> charges;
    for (int i = 0; i < 300; ++i) {
        positions.emplace_back(far + Vec3(place(engine), place(engine), place(engine)));
        charges.push_back(i % 7 == 0 ? 0 : charge(engine));
    }
    SurfaceMesh mesh;
    for (int i = 0; i < 37; ++i) {  // no multiple of what is summed side by side
        const Vec3 direction = Vec3(place(engine), place(engine), place(engine)).normalized();
        mesh.places.emplace_back((far + 16 * direction).cast<float>());
        mesh.normals.emplace_back(direction.cast<float>());
    }

    const std::vector<float> found = find_potentials(mesh, positions, charges);

    REQUIRE(found.size() == 37);
    for (std::size_t v = 0; v < found.size(); ++v) {
        const Vec3 at = mesh.places[v].cast<double>() + 1.4 * mesh.normals[v].cast<double>();
        double sum = 0;
        for (std::size_t i = 0; i < positions.size(); ++i)
            sum += bjerrum * charges[i] / (4 * (positions[i] - at).squaredNorm());
        CHECK(found[v] == Approx(sum).epsilon(3e-4).margin(1e-3));
    }
}

TEST_CASE("at a charge the potential stays finite", "[molecule][surface]") {
    const std::vector<float> found =
        find_potentials(point_at({0, 0, 0}, {1, 0, 0}), std::vector<Vec3>{{0, 0, 0}},
                        std::vector<double>{-1}, {.outward = 0});

    CHECK(found.at(0) == Approx(-bjerrum / (4 * 0.25)).epsilon(2e-4));
    CHECK(find_potentials({}, {}, {}).empty());
}
