#include "forces/cmap.h"

#include "forces/torsion.h"
#include "tests/support/check_forces.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

using namespace palpa;

namespace {

using std::numbers::pi;

double angle_of(std::size_t point) { return -pi + static_cast<double>(point) * pi / 12; }

std::vector<double> rough_energies() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-5, 5);
    std::vector<double> energies(576);
    for (double& energy : energies) energy = uniform(random);
    return energies;
}

}  // namespace

TEST_CASE("a CMAP surface goes through the energies of its map", "[forces][cmap]") {
    const std::vector<double> energies = rough_energies();
    const CmapMap map = build_cmap_map(energies);

    for (std::size_t i = 0; i < 24; ++i) {
        for (std::size_t j = 0; j < 24; ++j) {
            INFO("point " << i << " " << j);
            CHECK(evaluate_cmap(map, angle_of(i), angle_of(j)).energy ==
                  Approx(energies[i * 24 + j]).margin(1e-12));
        }
    }
    CHECK(evaluate_cmap(map, pi, pi).energy == Approx(energies[0]).margin(1e-12));
}

TEST_CASE("a CMAP surface is smooth across the points and edges of its map", "[forces][cmap]") {
    const CmapMap map = build_cmap_map(rough_energies());
    constexpr double h = 1e-9;

    for (std::size_t i = 0; i < 24; ++i) {
        const double at = angle_of(i), other = 0.3 + 0.2 * static_cast<double>(i);
        const double before = i == 0 ? pi - h : at - h;
        const CmapValue low = evaluate_cmap(map, before, std::remainder(other, 2 * pi));
        const CmapValue high = evaluate_cmap(map, at + h, std::remainder(other, 2 * pi));
        INFO("at point " << i);
        CHECK(low.energy == Approx(high.energy).margin(1e-6));
        CHECK(low.slope_phi == Approx(high.slope_phi).margin(1e-5));
        CHECK(low.slope_psi == Approx(high.slope_psi).margin(1e-5));
    }
}

TEST_CASE("a CMAP of two cosines is two dihedrals", "[forces][cmap]") {
    std::vector<double> energies;
    for (std::size_t i = 0; i < 24; ++i) {
        for (std::size_t j = 0; j < 24; ++j) {
            energies.push_back(2 * std::cos(angle_of(i)) + std::sin(angle_of(j)));
        }
    }
    const CmapMap map = build_cmap_map(energies);

    for (double phi = -3; phi < 3; phi += 0.37) {
        for (double psi = -3; psi < 3; psi += 0.41) {
            const CmapValue value = evaluate_cmap(map, phi, psi);
            // Splines over steps of h = 0.26 rad: h^4/384 and h^3/24.
            CHECK(value.energy == Approx(2 * std::cos(phi) + std::sin(psi)).margin(5e-5));
            CHECK(value.slope_phi == Approx(-2 * std::sin(phi)).margin(2e-3));
            CHECK(value.slope_psi == Approx(std::cos(psi)).margin(1e-3));
        }
    }
}

TEST_CASE("CMAP forces are the derivative of the energy and move with the molecule",
          "[forces][cmap]") {
    const std::vector<CmapMap> maps{build_cmap_map(rough_energies())};
    const std::array terms{CmapTerm{{0, 1, 2, 3}, {1, 2, 3, 4}, 0},
                           CmapTerm{{5, 1, 2, 0}, {4, 3, 5, 0}, 0}};
    const auto add = [&](std::span<const Vec3> x, std::span<Vec3> f) {
        return add_cmap_forces(terms, maps, x, f);
    };
    std::mt19937 random(13);

    for (int round = 0; round < 10; ++round) {
        INFO("round " << round);
        test::check_forces(add, test::random_positions(random, 6, 2, 1));
    }
    test::check_balance(add, std::vector<Vec3>(6, Vec3::Zero()));
    test::check_balance(
        add, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}});  // in line
}

TEST_CASE("angles that are no numbers do not leave a CMAP's map", "[forces][cmap]") {
    const CmapMap map = build_cmap_map(rough_energies());
    const double none = std::numeric_limits<double>::quiet_NaN();

    CHECK(std::isnan(evaluate_cmap(map, none, 0).energy));
    CHECK(std::isnan(evaluate_cmap(map, 0, none).energy));
}
