#include "forces/term_hessians.h"

#include "charmm/cmap_map.h"
#include "forces/bonded.h"
#include "forces/cmap.h"
#include "forces/torsion.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using namespace palpa;

namespace {

std::vector<Vec3> random_places(std::uint32_t seed, std::size_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-0.4, 0.4);
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < count; ++i) {
        places.emplace_back(1.4 * static_cast<double>(i) + uniform(random),
                            1.2 * static_cast<double>(i % 2) + uniform(random), uniform(random));
    }
    return places;
}

// How far a Hessian over vectors is from the differences of a gradient over atoms, of the largest.
template <int Vectors, std::size_t Atoms, class FindGradient>
double worst_difference(const TermHessian<Vectors>& term, const Shares<Vectors, Atoms>& shares,
                        const std::vector<Vec3>& places, const FindGradient& find_gradient) {
    constexpr double h = 1e-4;
    double worst = 0;
    const double largest = term.hessian.cwiseAbs().maxCoeff();
    for (std::size_t j = 0; j < Atoms; ++j) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto moved = [&](double by) {
                std::vector<Vec3> there = places;
                there[j][axis] += by;
                return find_gradient(there);
            };
            const auto up = moved(h), down = moved(-h), up2 = moved(2 * h), down2 = moved(-2 * h);
            for (std::size_t i = 0; i < Atoms; ++i) {
                Vec3 expected = (8 * (up[i] - down[i]) - (up2[i] - down2[i])) / (12 * h);
                for (std::size_t v = 0; v < Vectors; ++v) {
                    for (std::size_t w = 0; w < Vectors; ++w) {
                        expected -= shares[v][i] * shares[w][j] *
                                    term.hessian.col(static_cast<int>(3 * w) + axis)
                                        .template segment<3>(static_cast<int>(3 * v));
                    }
                }
                worst = std::max(worst, expected.cwiseAbs().maxCoeff() / largest);
            }
        }
    }
    return worst;
}

template <class Add>
auto gradient_of(const Add& add) {
    return [add](const std::vector<Vec3>& places) {
        std::vector<Vec3> forces(places.size(), Vec3::Zero());
        add(places, forces);
        for (Vec3& force : forces) force = -force;
        return forces;
    };
}

}  // namespace

TEST_CASE("Hessians of bonded terms are the differences of their forces", "[forces][hessian]") {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        INFO("seed " << seed);
        const std::vector<Vec3> x = random_places(seed, 4);
        const std::array bond{Bond{0, 1, 300, 1.5}};
        const std::array angle{Angle{0, 1, 2, 45, 1.9}};
        const std::array dihedral{Dihedral{0, 1, 2, 3, 3, 1.4, 0.5}};
        const std::array improper{Improper{0, 1, 2, 3, 60, 0.2}};
        const TorsionHessian torsion = find_torsion_hessian(x[0] - x[1], x[1] - x[2], x[3] - x[2]);
        const auto of_torsion = [&](const auto& term) {
            const Slopes slopes = find_slopes(term, torsion.angle);
            return torsion.of_energy(slopes.first, slopes.second);
        };

        CHECK(worst_difference<1, 2>(find_spring_hessian(300, 1.5, x[0] - x[1]), spring_shares, x,
                                     gradient_of([&](const auto& p, auto& f) {
                                         add_bond_forces(bond, p, f);
                                     })) < 1e-9);
        CHECK(worst_difference<2, 3>(find_angle_hessian(angle[0], x[0] - x[1], x[2] - x[1]),
                                     angle_shares, x, gradient_of([&](const auto& p, auto& f) {
                                         add_angle_forces(angle, p, f);
                                     })) < 1e-9);
        CHECK(worst_difference<3, 4>(of_torsion(dihedral[0]), torsion_shares, x,
                                     gradient_of([&](const auto& p, auto& f) {
                                         add_dihedral_forces(dihedral, p, f);
                                     })) < 1e-8);
        CHECK(worst_difference<3, 4>(of_torsion(improper[0]), torsion_shares, x,
                                     gradient_of([&](const auto& p, auto& f) {
                                         add_improper_forces(improper, p, f);
                                     })) < 1e-8);
    }
}

TEST_CASE("gradients beside the Hessians are those of the forces", "[forces][hessian]") {
    const std::vector<Vec3> x = random_places(5, 4);
    const TorsionHessian torsion = find_torsion_hessian(x[0] - x[1], x[1] - x[2], x[3] - x[2]);
    const Torsion expected = evaluate_torsion(x[0], x[1], x[2], x[3]);

    CHECK(torsion.angle == expected.angle);
    CHECK((torsion.slope.head<3>() - expected.gradient[0]).norm() < 1e-14);
    CHECK((torsion.slope.segment<3>(3) - torsion.slope.head<3>() - expected.gradient[1]).norm() <
          1e-14);
    CHECK((torsion.slope.tail<3>() - expected.gradient[3]).norm() < 1e-14);
}

TEST_CASE("Hessians stay finite where atoms are in line or at one place", "[forces][hessian]") {
    const Vec3 u(1.5, 0, 0);

    CHECK(find_spring_hessian(300, 1.5, Vec3::Zero()).hessian.isZero());
    CHECK(find_angle_hessian({0, 1, 2, 45, 3.14}, u, -u).hessian.isZero());
    CHECK(find_angle_hessian({0, 1, 2, 45, 3.14}, u, Vec3::Zero()).hessian.isZero());
    CHECK(find_torsion_hessian(u, -u, Vec3(0, 1, 0)).hessian.isZero());
    const TorsionHessian nearly = find_torsion_hessian(u + Vec3(0, 1e-7, 0), -u, Vec3(0, 1, 0.3));
    CHECK(nearly.hessian.allFinite());
    CHECK(nearly.hessian.cwiseAbs().maxCoeff() < 1e6);
}

TEST_CASE("second slopes of a CMAP surface are the differences of its slopes",
          "[forces][hessian][cmap]") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-2, 2);
    std::vector<double> energies(std::size_t{24} * 24);
    for (double& energy : energies) energy = uniform(random);
    const CmapMap map = build_cmap_map(energies);
    constexpr double h = 1e-4;
    for (int i = 0; i < 50; ++i) {
        const double phi = 1.5 * uniform(random), psi = 1.5 * uniform(random);
        // Within one cell of the grid, whose lines are 0.26 rad apart.
        const auto beside_line = [](double angle) {
            return std::abs(std::remainder(angle, 3.14159265358979 / 12)) < 2 * h;
        };
        if (beside_line(phi) || beside_line(psi)) continue;

        const CmapSlopes slopes = find_cmap_slopes(map, phi, psi);

        const CmapValue here = evaluate_cmap(map, phi, psi);
        const CmapValue up = evaluate_cmap(map, phi + h, psi),
                        down = evaluate_cmap(map, phi - h, psi);
        const CmapValue right = evaluate_cmap(map, phi, psi + h),
                        left = evaluate_cmap(map, phi, psi - h);
        CHECK(slopes.phi == Approx(here.slope_phi).epsilon(1e-12).margin(1e-12));
        CHECK(slopes.psi == Approx(here.slope_psi).epsilon(1e-12).margin(1e-12));
        CHECK(slopes.phi_phi ==
              Approx((up.slope_phi - down.slope_phi) / (2 * h)).margin(1e-4).epsilon(1e-6));
        CHECK(slopes.phi_psi ==
              Approx((up.slope_psi - down.slope_psi) / (2 * h)).margin(1e-4).epsilon(1e-6));
        CHECK(slopes.phi_psi ==
              Approx((right.slope_phi - left.slope_phi) / (2 * h)).margin(1e-4).epsilon(1e-6));
        CHECK(slopes.psi_psi ==
              Approx((right.slope_psi - left.slope_psi) / (2 * h)).margin(1e-4).epsilon(1e-6));
    }
}
