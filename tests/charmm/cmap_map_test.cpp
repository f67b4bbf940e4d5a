#include "charmm/cmap_map.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

using namespace palpa;

namespace {

// Slopes per step of a natural cubic spline through y: second derivatives by the textbook's
// elimination, zero at the ends.
std::vector<double> natural_slopes(const std::vector<double>& y) {
    const std::size_t n = y.size();
    std::vector<double> curvature(n, 0), pivot(n, 4), right(n, 0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        right[i] = 6 * (y[i + 1] - 2 * y[i] + y[i - 1]);
        if (i > 1) {
            pivot[i] -= 1 / pivot[i - 1];
            right[i] -= right[i - 1] / pivot[i - 1];
        }
    }
    for (std::size_t i = n - 2; i > 0; --i) {
        curvature[i] = (right[i] - curvature[i + 1]) / pivot[i];
    }
    std::vector<double> slopes(n, 0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        slopes[i] = y[i + 1] - y[i] - (2 * curvature[i] + curvature[i + 1]) / 6;
    }
    return slopes;
}

}  // namespace

TEST_CASE("the splines of a CMAP map take a wave as splines do", "[charmm][cmap]") {
    // A periodic cubic spline through e^(iwx) has slopes 3 i sin(w)/(2 + cos(w)) e^(iwx) per step.
    constexpr double h = std::numbers::pi / 12;
    std::vector<double> energies;
    for (int i = 0; i < 24; ++i) {
        for (int j = 0; j < 24; ++j) energies.push_back(std::sin(2 * h * i) * std::cos(3 * h * j));
    }
    const auto factor = [](double w) { return 3 * std::sin(w) / (2 + std::cos(w)); };
    const double along_phi = factor(2 * h), along_psi = factor(3 * h);

    const CmapMap map = build_cmap_map(energies);

    for (int i = 0; i < 24; ++i) {
        for (int j = 0; j < 24; ++j) {
            const CmapPoint& point =
                map.points[static_cast<std::size_t>(i) * 24 + static_cast<std::size_t>(j)];
            const double phi = 2 * h * i, psi = 3 * h * j;
            CHECK(point.slope_phi ==
                  Approx(along_phi * std::cos(phi) * std::cos(psi)).margin(1e-13));
            CHECK(point.slope_psi ==
                  Approx(-along_psi * std::sin(phi) * std::sin(psi)).margin(1e-13));
            CHECK(point.twist ==
                  Approx(-along_phi * along_psi * std::cos(phi) * std::sin(psi)).margin(1e-13));
        }
    }
}

TEST_CASE("CHARMM's natural splines over a continued map give the same slopes", "[charmm][cmap]") {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> uniform(-5, 5);
    std::vector<double> energies(576);
    for (double& energy : energies) energy = uniform(random);

    const CmapMap map = build_cmap_map(energies);

    for (std::size_t line = 0; line < 24; ++line) {
        std::vector<double> row, column;  // half a period more at either side
        for (std::size_t i = 0; i < 48; ++i) {
            row.push_back(energies[line * 24 + (i + 12) % 24]);
            column.push_back(energies[(i + 12) % 24 * 24 + line]);
        }
        const std::vector<double> along_psi = natural_slopes(row);
        const std::vector<double> along_phi = natural_slopes(column);
        for (std::size_t i = 0; i < 24; ++i) {
            CHECK(map.points[line * 24 + i].slope_psi == Approx(along_psi[i + 12]).margin(5e-6));
            CHECK(map.points[i * 24 + line].slope_phi == Approx(along_phi[i + 12]).margin(5e-6));
        }
    }
}
