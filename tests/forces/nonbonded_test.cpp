#include "forces/nonbonded.h"

#include "field/pair_field.h"
#include "tests/support/check_forces.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

using namespace palpa;

namespace {

using Electrostatics = ElectrostaticCutoff;
using VanDerWaals = VanDerWaalsCutoff;

// Atoms without a bond: every pair counts.
Topology build_gas(std::vector<double> charge, const std::vector<LennardJonesType>& types) {
    Topology topology;
    topology.charge = std::move(charge);
    for (std::uint32_t i = 0; i < topology.size(); ++i) topology.type.push_back(i % types.size());
    topology.lennard_jones = build_lennard_jones_table(types, {});
    topology.lennard_jones14 = topology.lennard_jones;
    topology.exclusions = build_exclusions({}, topology.size());
    return topology;
}

// Two unit charges, or two argon-like atoms, at a distance; energy and the force that pushes them
// apart.
struct Dimer {
    double energy, force;
};
Dimer at(double distance, const Topology& topology, const NonbondedSettings& settings) {
    const std::vector<Vec3> positions{{0, 0, 0}, {0, 0, distance}};
    std::vector<Vec3> forces(2, Vec3::Zero());
    const NonbondedEnergy energy = add_nonbonded_forces(topology, settings, positions, forces);
    return {energy.van_der_waals + energy.electrostatic, forces[1].z()};
}
const Topology unit_charges = build_gas({1, 1}, {{0, 0}});
const Topology argon = build_gas({0, 0}, {{0.2, 1.9}});

double switching(double r, double m, double c) {
    if (r <= m) return 1;
    if (r >= c) return 0;
    return std::pow(c * c - r * r, 2) * (c * c + 2 * r * r - 3 * m * m) /
           std::pow(c * c - m * m, 3);
}

// The energy whose force is `force` and which is 0 at c, by Simpson's rule.
template <class Force>
double integrate(const Force& force, double r, double c) {
    constexpr int steps = 4000;
    const double h = (c - r) / steps;
    double sum = force(r) + force(c);
    for (int i = 1; i < steps; ++i) sum += (i % 2 ? 4 : 2) * force(r + i * h);
    return sum * h / 3;
}

}  // namespace

TEST_CASE("two argon-like atoms and two charges by hand", "[forces][nonbonded]") {
    CHECK(at(3.8, argon, {}).energy == Approx(-0.2).epsilon(1e-14));
    CHECK(at(3.8, argon, {}).force == Approx(0).margin(1e-14));
    CHECK(at(1.9, argon, {}).energy == Approx(0.2 * (4096 - 128)).epsilon(1e-13));
    CHECK(at(2, unit_charges, {}).energy == Approx(332.0716 / 2).epsilon(1e-14));
    CHECK(at(2, unit_charges, {}).force == Approx(332.0716 / 4).epsilon(1e-14));
    CHECK(at(2, unit_charges, {.dielectric = 80}).energy == Approx(332.0716 / 160).epsilon(1e-14));
    CHECK(at(3, unit_charges, {.dielectric = 1.5, .distance_dielectric = true}).energy ==
          Approx(332.0716 / (1.5 * 9)).epsilon(1e-14));
    CHECK(at(3, unit_charges, {.dielectric = 1.5, .distance_dielectric = true}).force ==
          Approx(2 * 332.0716 / (1.5 * 27)).epsilon(1e-14));
}

TEST_CASE("all pairs agree with the field between two groups", "[forces][nonbonded]") {
    // Two groups whose inner pairs are excluded by bonds from one atom to its group.
    std::mt19937 random(17);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const std::vector<LennardJonesType> types{{0.15, 1.7}, {0.046, 0.22}, {0.07, 2.0}};
    Topology topology = build_gas(std::vector<double>(9), types);
    for (double& charge : topology.charge) charge = uniform(random);
    std::vector<Bond> bonds;
    for (std::uint32_t i = 1; i < 4; ++i) bonds.push_back({0, i, 0, 0});
    for (std::uint32_t i = 5; i < 9; ++i) bonds.push_back({4, i, 0, 0});
    topology.exclusions = build_exclusions(bonds, 9);
    const std::vector<Vec3> positions = test::random_positions(random, 9, 4, 1.5);
    std::vector<double> sqrt_epsilon, half_rmin;
    for (const std::uint32_t type : topology.type) {
        sqrt_epsilon.push_back(std::sqrt(types[type].epsilon));
        half_rmin.push_back(types[type].half_rmin);
    }
    const auto points = [&](std::size_t first, std::size_t count) {
        return FieldPoints{std::span(positions).subspan(first, count),
                           std::span(topology.charge).subspan(first, count),
                           std::span(sqrt_epsilon).subspan(first, count),
                           std::span(half_rmin).subspan(first, count)};
    };
    std::vector<Vec3> forces(9, Vec3::Zero()), expected(9, Vec3::Zero());

    const NonbondedEnergy energy = add_nonbonded_forces(topology, {}, positions, forces);

    const FieldSum field =
        add_pair_forces(points(0, 4), points(4, 5), {units::charmm_coulomb_constant},
                        std::span(expected).first(4), std::span(expected).last(5));
    CHECK(energy.van_der_waals == Approx(field.van_der_waals).epsilon(1e-13));
    CHECK(energy.electrostatic == Approx(field.electrostatic).epsilon(1e-13));
    for (std::size_t i = 0; i < 9; ++i) {
        CHECK((forces[i] - expected[i]).norm() < 1e-12 * (1 + expected[i].norm()));
    }
}

TEST_CASE("atoms three bonds apart have numbers of their own, nearer ones none",
          "[forces][nonbonded]") {
    // A chain of five.
    Topology topology = build_gas({1, 0.5, -1, 2, 0.25}, {{0.1, 2}});
    topology.lennard_jones14 =
        build_lennard_jones_table(std::vector<LennardJonesType>{{0.02, 1.5}}, {});
    topology.exclusions = build_exclusions(
        std::array{Bond{0, 1, 0, 0}, Bond{1, 2, 0, 0}, Bond{2, 3, 0, 0}, Bond{3, 4, 0, 0}}, 5);
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
    std::vector<Vec3> forces(5, Vec3::Zero());

    const NonbondedEnergy plain = add_nonbonded_forces(topology, {}, positions, forces);
    const NonbondedEnergy special =
        add_nonbonded14_forces(topology, {.coulomb14_factor = 0.5}, positions, forces);

    // Plain: the two ends, at their Rmin. Special: 0-3 and 1-4, each at its Rmin of 3 Å.
    CHECK(plain.van_der_waals == Approx(-0.1).epsilon(1e-14));
    CHECK(plain.electrostatic == Approx(332.0716 * 0.25 / 4).epsilon(1e-14));
    CHECK(special.van_der_waals == Approx(2 * -0.02).epsilon(1e-14));
    CHECK(special.electrostatic == Approx(0.5 * 332.0716 * (2 + 0.125) / 3).epsilon(1e-14));
}

TEST_CASE("an NBFIX pair replaces the combined numbers, either way round", "[forces][nonbonded]") {
    const bool turned = GENERATE(false, true);
    Topology topology = build_gas({0, 0}, {{0.1, 2}, {0.2, 1}});
    topology.lennard_jones = build_lennard_jones_table(
        std::vector<LennardJonesType>{{0.1, 2}, {0.2, 1}}, std::array{Nbfix{1, 0, {0.7, 3.5}}});
    if (turned) std::swap(topology.type[0], topology.type[1]);

    CHECK(at(3.5, topology, {}).energy == Approx(-0.7).epsilon(1e-14));
}

TEST_CASE("electrostatic cutoffs are CHARMM's functions", "[forces][nonbonded][cutoff]") {
    constexpr double C = 332.0716, m = 8, c = 11;
    const auto settings = [](Electrostatics kind, bool distance) {
        return NonbondedSettings{.distance_dielectric = distance,
                                 .electrostatics = kind,
                                 .van_der_waals = VanDerWaals::Switch,
                                 .switch_from = m,
                                 .cutoff = c};
    };
    const double r = GENERATE(0.5, 3.0, 7.9, 8.1, 9.5, 10.9);
    INFO(r << " Å");

    for (const bool distance : {false, true}) {
        INFO("distance dielectric " << distance);
        const auto whole = [&](double x) { return distance ? C / (x * x) : C / x; };
        const auto force = [&](double x) { return distance ? 2 * C / (x * x * x) : C / (x * x); };
        CHECK(at(r, unit_charges, settings(Electrostatics::Switch, distance)).energy ==
              Approx(whole(r) * switching(r, m, c)).epsilon(1e-12));
        CHECK(at(r, unit_charges, settings(Electrostatics::Shift, distance)).energy ==
              Approx(whole(r) * std::pow(1 - r * r / (c * c), 2)).epsilon(1e-12));
        // The force times S; its integral is the energy.
        const Dimer switched = at(r, unit_charges, settings(Electrostatics::ForceSwitch, distance));
        CHECK(switched.force == Approx(force(r) * switching(r, m, c)).epsilon(1e-12));
        const auto force_switched = [&](double x) { return force(x) * switching(x, m, c); };
        const double split = std::max(r, m);
        CHECK(switched.energy ==
              Approx(integrate(force_switched, r, split) + integrate(force_switched, split, c))
                  .epsilon(1e-8));
    }
    // The force less its value at the cutoff.
    const Dimer shifted = at(r, unit_charges, settings(Electrostatics::ForceShift, false));
    const auto force_shifted = [](double x) { return C / (x * x) - C / (c * c); };
    CHECK(shifted.force == Approx(force_shifted(r)).epsilon(1e-12));
    CHECK(shifted.energy == Approx(integrate(force_shifted, r, c)).epsilon(1e-8));
}

TEST_CASE("van der Waals cutoffs are CHARMM's functions", "[forces][nonbonded][cutoff]") {
    constexpr double m = 5, c = 7;
    const double r = GENERATE(3.0, 4.9, 5.1, 6.0, 6.9);
    INFO(r << " Å");
    const double s6 = std::pow(3.8 / r, 6), whole = 0.2 * (s6 * s6 - 2 * s6);
    const auto settings = [](VanDerWaals kind) {
        return NonbondedSettings{.electrostatics = Electrostatics::Shift,
                                 .van_der_waals = kind,
                                 .switch_from = m,
                                 .cutoff = c};
    };

    CHECK(at(r, argon, settings(VanDerWaals::Switch)).energy ==
          Approx(whole * switching(r, m, c)).epsilon(1e-12));
    const Dimer switched = at(r, argon, settings(VanDerWaals::ForceSwitch));
    if (r < m) {
        CHECK(switched.force == Approx(at(r, argon, {}).force).epsilon(1e-12));
        const double offset =
            at(4, argon, settings(VanDerWaals::ForceSwitch)).energy - at(4, argon, {}).energy;
        CHECK(switched.energy == Approx(whole + offset).epsilon(1e-12));
    } else {
        // Steinbach and Brooks, eq. 10 to 13, worked out for A = 0.2 Rmin^12, B = 0.4 Rmin^6.
        const double a = 0.2 * std::pow(3.8, 12), b = 0.4 * std::pow(3.8, 6);
        const double k12 = std::pow(c, 6) / (std::pow(c, 6) - std::pow(m, 6));
        const double k6 = std::pow(c, 3) / (std::pow(c, 3) - std::pow(m, 3));
        CHECK(switched.energy == Approx(a * k12 * std::pow(std::pow(r, -6) - std::pow(c, -6), 2) -
                                        b * k6 * std::pow(std::pow(r, -3) - std::pow(c, -3), 2))
                                     .epsilon(1e-12));
    }
}

TEST_CASE("cutoffs leave no step in energy or force, and nothing behind them",
          "[forces][nonbonded][cutoff]") {
    constexpr double m = 6, c = 9;
    const auto kind =
        GENERATE(Electrostatics::Switch, Electrostatics::Shift, Electrostatics::ForceShift,
                 Electrostatics::ForceSwitch, Electrostatics::CubicShift);
    const auto van_der_waals =
        GENERATE(VanDerWaals::Switch, VanDerWaals::ForceSwitch, VanDerWaals::SmoothSwitch);
    const bool distance = GENERATE(false, true);
    const NonbondedSettings settings{.distance_dielectric = distance,
                                     .electrostatics = kind,
                                     .van_der_waals = van_der_waals,
                                     .switch_from = m,
                                     .cutoff = c};
    if (find_problem(settings)) return;  // force shift with a distance-dependent dielectric
    Topology ions = build_gas({1, 1}, {{0.2, 1.9}});

    for (const double edge : {m, c}) {
        INFO("at " << edge << " Å");
        const Dimer before = at(edge * (1 - 1e-10), ions, settings);
        const Dimer after = at(edge * (1 + 1e-10), ions, settings);
        CHECK(before.energy == Approx(after.energy).margin(1e-7));
        CHECK(before.force == Approx(after.force).margin(1e-7));
    }
    CHECK(at(c, ions, settings).energy == 0);
    CHECK(at(c, ions, settings).force == 0);
    CHECK(at(1e6, ions, settings).energy == 0);
}

TEST_CASE("non-bonded forces are the derivative of the energy and move with the molecule",
          "[forces][nonbonded]") {
    const auto kind = GENERATE(Electrostatics::None, Electrostatics::Switch, Electrostatics::Shift,
                               Electrostatics::ForceShift, Electrostatics::ForceSwitch,
                               Electrostatics::CubicShift);
    const auto van_der_waals = GENERATE(VanDerWaals::None, VanDerWaals::Switch,
                                        VanDerWaals::ForceSwitch, VanDerWaals::SmoothSwitch);
    const bool distance = GENERATE(false, true);
    const NonbondedSettings settings{.dielectric = 2,
                                     .distance_dielectric = distance,
                                     .electrostatics = kind,
                                     .van_der_waals = van_der_waals,
                                     .switch_from = 3.5,
                                     .cutoff = 6};
    if (find_problem(settings)) return;
    std::mt19937 random(19);
    Topology topology = build_gas(std::vector<double>(8), {{0.15, 1.2}, {0.05, 0.3}, {0.1, 1}});
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (double& charge : topology.charge) charge = uniform(random);
    topology.exclusions = build_exclusions(
        std::array{Bond{0, 3, 0, 0}, Bond{3, 5, 0, 0}, Bond{5, 2, 0, 0}, Bond{2, 6, 0, 0}}, 8);

    // Some pairs in every range.
    const std::vector<Vec3> positions = test::random_positions(random, 8, 3.5, 1.5);

    test::check_forces(
        [&](std::span<const Vec3> x, std::span<Vec3> f) {
            const NonbondedEnergy energy = add_nonbonded_forces(topology, settings, x, f);
            return energy.van_der_waals + energy.electrostatic;
        },
        positions);
    test::check_forces(
        [&](std::span<const Vec3> x, std::span<Vec3> f) {
            const NonbondedEnergy energy = add_nonbonded14_forces(topology, settings, x, f);
            return energy.van_der_waals + energy.electrostatic;
        },
        positions);
}

TEST_CASE("atoms at one place are finite, and the force goes to zero there",
          "[forces][nonbonded]") {
    const auto kind = GENERATE(Electrostatics::None, Electrostatics::Switch, Electrostatics::Shift,
                               Electrostatics::ForceShift, Electrostatics::ForceSwitch,
                               Electrostatics::CubicShift);
    const auto van_der_waals = GENERATE(VanDerWaals::None, VanDerWaals::Switch,
                                        VanDerWaals::ForceSwitch, VanDerWaals::SmoothSwitch);
    const NonbondedSettings settings{.electrostatics = kind, .van_der_waals = van_der_waals};
    const Topology oxygens = build_gas({-0.8, -0.8}, {{0.15, 1.77}});

    for (const double distance :
         {0.0, std::numeric_limits<double>::denorm_min(), 1e-12, 1e-3, 0.05, 0.1, 1.0}) {
        INFO(distance << " Å");
        CHECK(std::isfinite(at(distance, oxygens, settings).energy));
        CHECK(std::isfinite(at(distance, oxygens, settings).force));
    }
    CHECK(at(0, oxygens, settings).force == 0);
    const double core = pair_core_radius;
    CHECK(at(core * (1 - 1e-12), oxygens, settings).energy ==
          Approx(at(core * (1 + 1e-12), oxygens, settings).energy).epsilon(1e-9));
    constexpr double h = 1e-5;
    CHECK(at(0.04, oxygens, settings).force == Approx(-(at(0.04 + h, oxygens, settings).energy -
                                                        at(0.04 - h, oxygens, settings).energy) /
                                                      (2 * h))
                                                   .epsilon(1e-6));
}

TEST_CASE("settings that mean nothing are named", "[forces][nonbonded]") {
    CHECK_FALSE(find_problem({}));
    CHECK(find_problem({.dielectric = 0}));
    CHECK(find_problem({.electrostatics = Electrostatics::Shift, .cutoff = 0}));
    CHECK(find_problem({.van_der_waals = VanDerWaals::Switch, .switch_from = 12, .cutoff = 12}));
    CHECK(
        find_problem({.distance_dielectric = true, .electrostatics = Electrostatics::ForceShift}));
}
