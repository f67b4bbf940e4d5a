#include "forces/pair_hessian.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
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
                 ElectrostaticCutoff::ForceShift, ElectrostaticCutoff::ForceSwitch);
    settings.van_der_waals = GENERATE(VanDerWaalsCutoff::None, VanDerWaalsCutoff::Switch,
                                      VanDerWaalsCutoff::ForceSwitch);
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

TEST_CASE("two charges have the second derivatives of 1/r", "[forces][hessian]") {
    const PairHessian pair = PairHessianLaw({}).evaluate(4, 3, {0, 1});

    CHECK_THAT(pair.first, WithinRel(-3.0 / 8, 1e-14));       // -q/r^3
    CHECK_THAT(pair.second, WithinRel(3 * 3.0 / 32, 1e-14));  // 3 q/r^5
}
