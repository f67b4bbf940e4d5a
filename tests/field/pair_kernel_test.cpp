#include "field/pair_kernel.h"

#include "core/units.h"
#include "field/processor.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

struct Gas {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;
};

// On a grid of 2.5 Å, shaken.
Gas random_gas(std::size_t atoms) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Gas gas;
    for (std::size_t i = 0; i < atoms; ++i) {
        const std::size_t row = i / 7 % 7, layer = i / 49;
        const auto x = static_cast<double>(i % 7), y = static_cast<double>(row),
                   z = static_cast<double>(layer);
        const double dx = uniform(random), dy = uniform(random), dz = uniform(random);
        gas.positions.push_back(2.5 * Vec3(x, y, z) + 0.4 * Vec3(dx, dy, dz));
        gas.charge.push_back(uniform(random));
        gas.sqrt_epsilon.push_back(std::sqrt(0.1 + 0.05 * uniform(random)));
        gas.half_rmin.push_back(1.4 + 0.4 * uniform(random));
    }
    return gas;
}

struct Result {
    PairKernelSum sum;
    std::vector<Vec3> forces;
};

Result evaluate(const Gas& gas, const ClusterList& list, const PairScheme& scheme,
                std::size_t threads = 1) {
    Result result{{}, std::vector<Vec3>(gas.positions.size(), Vec3::Zero())};
    PairWorkspace workspace =
        build_pair_workspace(list, {gas.charge, gas.sqrt_epsilon, gas.half_rmin});
    result.sum = add_cluster_pair_forces(list, scheme, gas.positions, workspace, result.forces,
                                         PairResult::ForcesAndEnergies, {threads});
    return result;
}

Result evaluate_all(const Gas& gas) {
    return evaluate(gas, build_full_cluster_list(gas.positions.size(), {}),
                    {.coulomb = units::charmm_coulomb_constant});
}

constexpr PairScheme force_switch{
    units::charmm_coulomb_constant, false, ElectrostaticCutoff::ForceSwitch,
    VanDerWaalsCutoff::ForceSwitch, 5,     6};

}  // namespace

TEST_CASE("two atoms by hand, on every kind of processor", "[field][kernel]") {
    // 3 Å apart where a single float has steps of 5e-4 Å.
    const Gas gas{{{4000.125, 2, 7}, {4000.125, 2, 10}}, {0.5, -0.25}, {0.4, 0.5}, {1.5, 2}};
    for (const std::string& kind : list_processor_kinds()) {
        INFO(kind);
        use_processor_kind(kind);

        const Result result = evaluate_all(gas);

        const double s6 = std::pow(3.5 / 3, 6);
        const double coulomb = -0.125 * 332.0716 / 3;
        REQUIRE(result.sum.is_sound);
        // A rounding of single precision, 6e-8, counts twelvefold in r^-12.
        CHECK(result.sum.van_der_waals ==
              Approx(0.2 * (s6 * s6 - 2 * s6)).margin(7e-7 * 0.2 * (s6 * s6 + 2 * s6)));
        CHECK(result.sum.electrostatic == Approx(coulomb).epsilon(3e-7));
        const double force = 12 * 0.2 * (s6 * s6 - s6) / 3 + coulomb / 3;
        CHECK(result.forces[1].z() == Approx(force).margin(7e-7 * 12 * 0.2 * (s6 * s6 + s6) / 3));
        CHECK(result.forces[0].z() == -result.forces[1].z());
    }
    use_processor_kind(list_processor_kinds().front());
}

TEST_CASE("a repeated sum has the same bits, whatever the number of threads", "[field][kernel]") {
    const Gas gas = random_gas(300);
    const std::size_t threads = GENERATE(1, 2, 3);
    const ClusterList list = build_cluster_list(gas.positions, {}, 6, 1);

    const Result first = evaluate(gas, list, force_switch, threads);
    const Result again = evaluate(gas, list, force_switch, threads);
    const Result single = evaluate(gas, list, force_switch, 1);

    REQUIRE(first.sum.is_sound);
    CHECK(first.sum.van_der_waals == again.sum.van_der_waals);
    CHECK(first.sum.electrostatic == again.sum.electrostatic);
    CHECK(first.sum.electrostatic == Approx(single.sum.electrostatic).epsilon(1e-6));
    Vec3 total = Vec3::Zero();
    for (std::size_t i = 0; i < 300; ++i) {
        CHECK(first.forces[i] == again.forces[i]);
        CHECK((first.forces[i] - single.forces[i]).norm() < 1e-5 * (10 + single.forces[i].norm()));
        total += first.forces[i];
    }
    CHECK(total.norm() < 1e-3);
}

TEST_CASE("an updated list gives the sum of a new one", "[field][kernel]") {
    Gas gas = random_gas(300);
    ClusterList list = build_cluster_list(gas.positions, {}, 6, 1);
    std::vector<std::uint32_t> moved;
    for (std::uint32_t i = 0; i < 300; ++i) {
        if (gas.positions[i].x() > 11) moved.push_back(i);
    }
    REQUIRE(moved.size() > 10);

    for (int step = 1; step <= 12; ++step) {
        INFO("step " << step);
        for (const std::uint32_t i : moved) gas.positions[i] += Vec3(0.02, 0, 0.2);
        const ListChange change = update_cluster_list(gas.positions, {}, moved, list);
        REQUIRE(change != ListChange::Clusters);

        const Result result = evaluate(gas, list, force_switch, 2);
        const Result expected =
            evaluate(gas, build_cluster_list(gas.positions, {}, 6, 0), force_switch);
        REQUIRE(result.sum.is_sound);
        CHECK(result.sum.van_der_waals == Approx(expected.sum.van_der_waals).epsilon(1e-5));
        CHECK(result.sum.electrostatic ==
              Approx(expected.sum.electrostatic).epsilon(1e-5).margin(1e-3));
        for (std::size_t i = 0; i < 300; ++i) {
            CHECK((result.forces[i] - expected.forces[i]).norm() <
                  1e-5 * (10 + expected.forces[i].norm()));
        }
    }
}

TEST_CASE("a list that is not outdated gives the sum of a new one", "[field][kernel]") {
    Gas gas = random_gas(300);
    const ClusterList list = build_cluster_list(gas.positions, {}, 6, 1);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-0.28, 0.28);
    for (Vec3& place : gas.positions) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        place += Vec3(x, y, z);
    }
    REQUIRE_FALSE(is_outdated(list, gas.positions));

    const Result result = evaluate(gas, list, force_switch);
    const Result expected =
        evaluate(gas, build_cluster_list(gas.positions, {}, 6, 0), force_switch);

    CHECK(result.sum.van_der_waals == Approx(expected.sum.van_der_waals).epsilon(1e-5));
    for (std::size_t i = 0; i < 300; ++i) {
        CHECK((result.forces[i] - expected.forces[i]).norm() <
              1e-5 * (10 + expected.forces[i].norm()));
    }
}

TEST_CASE("what single precision cannot do is told, and nothing is added", "[field][kernel]") {
    Gas gas = random_gas(20);
    SECTION("two atoms at one place") { gas.positions[3] = gas.positions[17]; }
    SECTION("two atoms close by") {
        gas.positions[3] = gas.positions[17] + Vec3(0, 0.99 * nearest_single_precision, 0);
    }
    SECTION("an atom far off") { gas.positions[9].x() = 1e5; }
    SECTION("an atom nowhere") { gas.positions[9].x() = std::numeric_limits<double>::quiet_NaN(); }

    const Result result = evaluate_all(gas);

    CHECK_FALSE(result.sum.is_sound);
    for (const Vec3& force : result.forces) CHECK(force == Vec3(Vec3::Zero()));
}

TEST_CASE("pairs left out may be at one place", "[field][kernel]") {
    Gas gas = random_gas(20);
    gas.positions[3] = gas.positions[17];
    const ClusterList list =
        build_full_cluster_list(20, std::vector<std::array<std::uint32_t, 2>>{{17, 3}});

    const Result result = evaluate(gas, list, {.coulomb = 332});

    CHECK(result.sum.is_sound);
    for (const Vec3& force : result.forces) CHECK(force.allFinite());
}
