#include "forces/pair_hessian.h"

#include "tests/support/solvation_of.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using Catch::Matchers::WithinRel;

namespace {

constexpr LennardJonesPair numbers{0.13, 3.7};

// Two atoms of which one has charge 0.6 and one -0.4.
Topology two_atoms() {
    Topology topology;
    topology.charge = {0.6, -0.4};
    topology.type = {0, 0};
    topology.lennard_jones = {1, {numbers}};
    topology.lennard_jones14 = topology.lennard_jones;
    topology.exclusions.first = {0, 0, 0};
    return topology;
}

// dE/du at a distance, u = r^2/2, as the forces have it: the force is -dE/du times the distance.
double first_at(const NonbondedSettings& settings, double u) {
    const double r = std::sqrt(2 * u);
    const std::array positions{Vec3(r, 0, 0), Vec3(0, 0, 0)};
    std::array forces{Vec3(0, 0, 0), Vec3(0, 0, 0)};
    const std::array<std::array<std::uint32_t, 2>, 1> pairs{{{0, 1}}};
    add_pair_forces(two_atoms(), settings, pairs, positions, forces);
    return -forces[0].x() / r;
}

}  // namespace

TEST_CASE("second derivatives of a pair are the differences of its force, whatever the cutoff",
          "[forces][hessian]") {
    NonbondedSettings settings;
    settings.switch_from = 7;
    settings.cutoff = 9;
    settings.electrostatics =
        GENERATE(ElectrostaticCutoff::None, ElectrostaticCutoff::Switch, ElectrostaticCutoff::Shift,
                 ElectrostaticCutoff::ForceShift, ElectrostaticCutoff::ForceSwitch,
                 ElectrostaticCutoff::CubicShift);
    settings.van_der_waals =
        GENERATE(VanDerWaalsCutoff::None, VanDerWaalsCutoff::Switch, VanDerWaalsCutoff::ForceSwitch,
                 VanDerWaalsCutoff::SmoothSwitch);
    settings.distance_dielectric = GENERATE(false, true);
    if (find_problem(settings)) return;
    const PairHessianLaw law(settings);
    const double charges = settings.coulomb_constant * 0.6 * -0.4;

    for (const double r : {0.03, 1.2, 2.9, 4.1, 6.99, 7.01, 8.2, 8.99, 9.01, 14.0}) {
        INFO("r = " << r);
        const double u = 0.5 * r * r, h = 1e-5 * u;
        const PairHessian pair = law.evaluate(r * r, charges, numbers);

        const double first = first_at(settings, u);
        const double second = (8 * (first_at(settings, u + h) - first_at(settings, u - h)) -
                               (first_at(settings, u + 2 * h) - first_at(settings, u - 2 * h))) /
                              (12 * h);

        CHECK(std::abs(pair.first - first) <= 1e-12 * std::abs(first));
        CHECK(std::abs(pair.second - second) <= 1e-8 * (std::abs(second) + std::abs(first) / u));
    }
}

TEST_CASE("second derivatives of solvated pairs are the differences of their force",
          "[forces][hessian][solvation]") {
    Topology topology = two_atoms();
    topology.solvation = test::solvation_of(std::array<std::string, 2>{"NH3", "CT3"});
    const NonbondedSettings settings =
        eef1_settings(GENERATE(SolvationEnd::None, SolvationEnd::Sharp, SolvationEnd::Smooth));
    const TopologyPairHessian law(topology, settings);
    const std::array<std::array<std::uint32_t, 2>, 1> pairs{{{0, 1}}};
    for (const bool is_14 : {false, true}) {
        const auto first_of = [&](double u) {
            const std::array positions{Vec3(std::sqrt(2 * u), 0, 0), Vec3(0, 0, 0)};
            std::array forces{Vec3(0, 0, 0), Vec3(0, 0, 0)};
            is_14 ? add_pair14_forces(topology, settings, pairs, positions, forces)
                  : add_pair_forces(topology, settings, pairs, positions, forces);
            return -forces[0].x() / positions[0].x();
        };
        for (const double r : {0.03, 1.2, 2.9, 6.99, 7.5, 8.2, 8.51, 8.99, 9.2, 9.49, 9.6}) {
            INFO("r = " << r);
            const double u = 0.5 * r * r, h = 1e-4 * u;
            const PairHessian pair =
                is_14 ? law.three_bonds_apart(0, 1, r * r) : law.plain(0, 1, r * r);
            const double first = first_of(u);
            const double second = (8 * (first_of(u + h) - first_of(u - h)) -
                                   (first_of(u + 2 * h) - first_of(u - 2 * h))) /
                                  (12 * h);
            CHECK(std::abs(pair.first - first) <= 1e-12 * std::abs(first));
            CHECK(std::abs(pair.second - second) <=
                  1e-7 * (std::abs(second) + std::abs(first) / u));
        }
    }
}

TEST_CASE("two charges have the second derivatives of 1/r", "[forces][hessian]") {
    const PairHessian pair = PairHessianLaw({}).evaluate(4, 3, {0, 1});

    CHECK_THAT(pair.first, WithinRel(-3.0 / 8, 1e-14));       // -q/r^3
    CHECK_THAT(pair.second, WithinRel(3 * 3.0 / 32, 1e-14));  // 3 q/r^5
}
