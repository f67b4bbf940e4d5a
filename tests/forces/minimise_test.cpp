#include "forces/minimise.h"

#include "forces/force_field.h"
#include "tests/support/check_forces.h"
#include "tests/support/paths.h"
#include "tests/support/reference_case.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

using namespace palpa;

namespace {

// Atoms without charge, of one type: epsilon 0.2 kcal/mol, Rmin 3.8 Å.
Topology build_argon(std::size_t atoms, const std::vector<Bond>& bonds = {}) {
    Topology topology;
    topology.charge.assign(atoms, 0.0);
    topology.type.assign(atoms, 0);
    topology.bonds = bonds;
    topology.lennard_jones =
        build_lennard_jones_table(std::vector<LennardJonesType>{{0.2, 1.9}}, {});
    topology.lennard_jones14 = topology.lennard_jones;
    topology.exclusions = build_exclusions(bonds, atoms);
    return topology;
}

MinimiseSettings with_list(double tolerance, std::size_t steps = 1000) {
    MinimiseSettings settings;
    settings.nonbonded = {.electrostatics = ElectrostaticCutoff::ForceShift,
                          .van_der_waals = VanDerWaalsCutoff::Switch,
                          .switch_from = 7,
                          .cutoff = 9};
    settings.force_tolerance = tolerance;
    settings.steps = steps;
    return settings;
}

MinimiseSettings with_all_pairs(double tolerance) {
    MinimiseSettings settings = with_list(tolerance);
    settings.nonbonded = {};
    return settings;
}

struct Peptide {
    Topology topology;
    std::vector<Vec3> positions;
};

// Shaken by up to `noise` Å along each axis.
Peptide read_peptide(double noise) {
    Peptide peptide{test::read_reference_case(test::test_data("tetra_aera_c36m.ff.json")).topology,
                    test::read_reference_frames(test::test_data("tetra_aera_c36m.frames.json"))
                        .front()
                        .positions};
    std::mt19937 random(43);
    std::uniform_real_distribution<double> uniform(-noise, noise);
    for (Vec3& place : peptide.positions)
        place += Vec3(uniform(random), uniform(random), uniform(random));
    return peptide;
}

bool is_finite(const std::vector<Vec3>& positions) {
    for (const Vec3& place : positions) {
        if (!place.allFinite()) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("a stretched bond comes to its length", "[forces][minimise]") {
    const Topology topology = build_argon(2, {{0, 1, 300, 1.5}});
    std::vector<Vec3> positions{{0, 0, 0}, {0, 4, 3}};

    const MinimiseReport report = minimise(topology, with_all_pairs(1e-6), {}, positions);

    CHECK(report.end == MinimiseEnd::Converged);
    CHECK(report.before.bond == Approx(300 * 3.5 * 3.5).epsilon(1e-14));
    CHECK(report.after.total() < 1e-12);
    CHECK(report.lists == 0);
    // k (r - r0) below 1e-6 kcal/mol/Å.
    CHECK((positions[1] - positions[0]).norm() == Approx(1.5).margin(1e-8));
    // Neither pushed nor turned.
    CHECK((positions[1] + positions[0] - Vec3(0, 4, 3)).norm() < 1e-12);
    CHECK((positions[1] - positions[0]).cross(Vec3(0, 4, 3)).norm() < 1e-12);
}

TEST_CASE("two argon-like atoms come to Rmin, from a clash and from afar", "[forces][minimise]") {
    const double distance = GENERATE(0.1, 0.5, 2.0, 3.0, 5.0, 6.5);
    INFO(distance << " Å");
    const Topology topology = build_argon(2);
    std::vector<Vec3> positions{{0, 0, 0}, {0, 0, distance}};

    const MinimiseReport report = minimise(
        topology, GENERATE(true, false) ? with_list(1e-7) : with_all_pairs(1e-7), {}, positions);

    CHECK(report.end == MinimiseEnd::Converged);
    CHECK(report.rms_force <= 1e-7);
    // Their curvature there is 72 epsilon/Rmin^2 = 1 kcal/mol/Å^2.
    CHECK((positions[1] - positions[0]).norm() == Approx(3.8).margin(1e-6));
    CHECK(report.after.total() == Approx(-0.2).epsilon(1e-9));
    CHECK(report.steps < 100);
}

TEST_CASE("a restraint and a force between two atoms balance", "[forces][minimise]") {
    // Two springs of 2 k = 20 and 2 kr = 10 kcal/mol/Å^2 behind each other, stretched by 3 Å.
    const Topology topology = build_argon(2, {{0, 1, 10, 1}});
    const std::vector<Vec3> references{{0, 0, 0}, {4, 0, 0}};
    const std::vector<double> k{0, 5};
    const std::vector<std::uint8_t> is_fixed{1, 0};
    std::vector<Vec3> positions = references;

    const MinimiseReport report =
        minimise(topology, with_all_pairs(1e-8), {k, references, is_fixed}, positions);

    CHECK(report.end == MinimiseEnd::Converged);
    CHECK(positions[1].x() == Approx(1 + 3 * 10.0 / 30).epsilon(1e-9));
    CHECK(report.after.bond == Approx(10 * 1.0).epsilon(1e-8));
    CHECK(report.restraint_before == 0);
    CHECK(report.restraint_after == Approx(5 * 4.0).epsilon(1e-8));
}

TEST_CASE("a shaken peptide goes down to rest, never up", "[forces][minimise]") {
    const double noise = GENERATE(0.1, 0.6);
    const MinimiseSettings settings =
        GENERATE(true, false) ? with_list(0.01, 5000) : with_all_pairs(0.01);
    auto [topology, positions] = read_peptide(noise);
    const std::vector<Vec3> start = positions;
    std::vector<double> energies;
    std::vector<std::size_t> steps;

    const MinimiseReport report =
        minimise(topology, settings, {}, positions, [&](std::size_t step, double energy) {
            steps.push_back(step);
            energies.push_back(energy);
        });

    CHECK(report.end == MinimiseEnd::Converged);
    CHECK(energies.front() == report.before.total());
    CHECK(energies.back() == report.after.total());
    REQUIRE(energies.size() == report.steps + 1);
    for (std::size_t i = 1; i < energies.size(); ++i) {
        CHECK(steps[i] == i);
        CHECK(energies[i] <= energies[i - 1]);
    }
    // At rest by the reference implementation too, which looks at all pairs.
    std::vector<Vec3> forces(positions.size(), Vec3::Zero());
    const EnergyTerms energy = add_forces(topology, settings.nonbonded, positions, forces);
    CHECK(energy.total() == Approx(report.after.total()).epsilon(1e-11));
    double sum2 = 0;
    for (const Vec3& force : forces) sum2 += force.squaredNorm();
    const double rms = std::sqrt(sum2 / (3.0 * static_cast<double>(forces.size())));
    CHECK(rms == Approx(report.rms_force).epsilon(1e-6));
    CHECK(rms <= 0.01);

    std::vector<Vec3> again = start;
    minimise(topology, settings, {}, again);
    CHECK(again == positions);
}

TEST_CASE("no atom moves farther in one step than it may", "[forces][minimise]") {
    auto [topology, positions] = read_peptide(0.6);
    MinimiseSettings settings = with_list(1e-3, 1);
    settings.largest_step = 0.05;

    for (int step = 0; step < 20; ++step) {
        const std::vector<Vec3> before = positions;
        REQUIRE(minimise(topology, settings, {}, positions).steps == 1);
        for (std::size_t i = 0; i < positions.size(); ++i)
            CHECK((positions[i] - before[i]).norm() <= 0.05 * (1 + 1e-12));
    }
}

TEST_CASE("fixed atoms do not move by a bit, and the others come to rest around them",
          "[forces][minimise]") {
    auto [topology, positions] = read_peptide(0.3);
    std::vector<std::uint8_t> is_fixed(positions.size(), 0);
    for (std::size_t i = 0; i < positions.size(); i += 2) is_fixed[i] = 1;
    const std::vector<Vec3> start = positions;
    const MinimiseSettings settings = with_list(0.01, 5000);

    const MinimiseReport report = minimise(topology, settings, {{}, {}, is_fixed}, positions);

    CHECK(report.end == MinimiseEnd::Converged);
    std::vector<Vec3> forces(positions.size(), Vec3::Zero());
    add_forces(topology, settings.nonbonded, positions, forces);
    double sum2 = 0;
    std::size_t free = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (is_fixed[i]) {
            CHECK(positions[i] == start[i]);
            continue;
        }
        CHECK(positions[i] != start[i]);
        sum2 += forces[i].squaredNorm();
        ++free;
    }
    CHECK(std::sqrt(sum2 / (3.0 * static_cast<double>(free))) <= 0.01 * (1 + 1e-9));

    std::fill(is_fixed.begin(), is_fixed.end(), 1);
    const std::vector<Vec3> before = positions;
    CHECK(minimise(topology, settings, {{}, {}, is_fixed}, positions).steps == 0);
    CHECK(positions == before);
}

TEST_CASE("atoms on top of each other part, and nothing becomes infinite", "[forces][minimise]") {
    auto [topology, positions] = read_peptide(0.0);
    const std::size_t last = positions.size() - 1;

    SECTION("two far along the chain, at 0.1 Å") {
        positions[last] = positions[0] + Vec3(0.1, 0, 0);
    }
    SECTION("two at one place") { positions[last] = positions[0]; }
    SECTION("three at one place") { positions[last] = positions[20] = positions[0]; }
    const MinimiseReport report = minimise(topology, with_list(0.1, 2000), {}, positions);

    CHECK(report.end == MinimiseEnd::Converged);
    CHECK(report.before.total() > 1e6);
    CHECK(report.after.total() < 100);
    CHECK(is_finite(positions));
    for (const Bond& bond : topology.bonds)
        CHECK((positions[bond.a] - positions[bond.b]).norm() == Approx(bond.r0).epsilon(0.1));
}

TEST_CASE("what has no way down stays where it is", "[forces][minimise]") {
    std::vector<Vec3> positions(5, Vec3(1, 2, 3));
    const Topology topology = build_argon(5);

    const MinimiseReport report = minimise(topology, with_list(0.1), {}, positions);

    CHECK(report.end == MinimiseEnd::Converged);
    CHECK(std::isfinite(report.after.total()));
    CHECK(positions == std::vector<Vec3>(5, Vec3(1, 2, 3)));
    positions.clear();
    CHECK(minimise(build_argon(0), with_list(0.1), {}, positions).end == MinimiseEnd::Converged);
}

TEST_CASE("a whole peptide on one point is finite", "[forces][minimise]") {
    auto [topology, positions] = read_peptide(0.0);
    std::fill(positions.begin(), positions.end(), Vec3::Zero());
    if (GENERATE(false, true)) {
        for (std::size_t i = 0; i < positions.size(); ++i)
            positions[i].x() = 0.01 * static_cast<double>(i);
    }

    const MinimiseReport report = minimise(topology, with_list(0.1, 200), {}, positions);

    CHECK(std::isfinite(report.after.total()));
    CHECK(report.after.total() <= report.before.total());
    CHECK(is_finite(positions));
}
