// Solvation in single precision against its reference in double, on every kind of processor.
#include "forces/fast_solvation.h"

#include "field/processor.h"
#include "forces/force_field.h"
#include "forces/group_forces.h"
#include "forces/solvation.h"
#include "tests/support/check_forces.h"
#include "tests/support/paths.h"
#include "tests/support/reference_case.h"
#include "tests/support/solvation_of.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// As dense as the heavy atoms of a protein, of its types, in chains of five.
struct HeavyGas {
    Topology topology;
    std::vector<Vec3> positions;
};

HeavyGas build_heavy_gas(std::size_t count, std::uint32_t seed, double apart = 1.9) {
    const std::array<std::string, 8> kinds{"NH3", "OC", "CT3", "HA1", "CT2", "CA", "C", "NC2"};
    std::mt19937 random(seed);
    HeavyGas gas;
    std::vector<std::string> types;
    std::vector<Bond> bonds;
    for (std::uint32_t i = 0; i < count; ++i) {
        types.push_back(kinds[random() % kinds.size()]);
        if (i % 5 != 0) bonds.push_back({i - 1, i, 0, 0});
    }
    gas.topology.charge.assign(count, 0);
    gas.topology.type.assign(count, 0);
    gas.topology.lennard_jones = {1, {{0, 1}}};
    gas.topology.lennard_jones14 = gas.topology.lennard_jones;
    gas.topology.exclusions = build_exclusions(bonds, count);
    gas.topology.solvation = test::solvation_of(types);
    gas.positions = test::random_positions(
        random, count, 0.5 * std::cbrt(static_cast<double>(count) * 19.0), apart);
    return gas;
}

struct SolvationSum {
    double energy = 0;
    std::vector<Vec3> forces;
};

// Pairs three bonds apart included, without what atoms have alone.
SolvationSum sum_in_double(const Topology& topology, const std::vector<Vec3>& positions) {
    SolvationSum sum{0, std::vector<Vec3>(positions.size(), Vec3::Zero())};
    sum.energy = add_solvation_forces(topology, SolvationEnd::Smooth, positions, sum.forces) +
                 add_solvation_forces(topology, SolvationEnd::Smooth, topology.exclusions.pairs14,
                                      positions, sum.forces);
    return sum;
}

double worst_solvation_force(const std::vector<Vec3>& forces, const std::vector<Vec3>& expected) {
    double squares = 0, worst = 0;
    for (const Vec3& force : expected) squares += force.squaredNorm();
    const double rms = std::sqrt(squares / static_cast<double>(forces.size()));
    for (std::size_t i = 0; i < forces.size(); ++i) {
        worst =
            std::max(worst, (forces[i] - expected[i]).norm() / std::max(rms, expected[i].norm()));
    }
    return worst;
}

}  // namespace

TEST_CASE("solvation in single precision is that in double", "[forces][fast][solvation]") {
    double worst = 0, worst_energy = 0;
    for (const std::size_t count : {6U, 40U, 700U}) {
        const HeavyGas gas = build_heavy_gas(count, 7);
        const FastSolvationAtoms atoms = build_fast_solvation_atoms(gas.topology);
        const SolvationSum expected = sum_in_double(gas.topology, gas.positions);
        for (const std::string& kind : list_processor_kinds()) {
            use_processor_kind(kind);
            for (const std::size_t threads : {1U, 3U}) {
                INFO(count << " atoms, " << kind << ", " << threads << " threads");
                FastSolvationPairs pairs;
                std::vector<Vec3> forces(count, Vec3::Zero());
                const double energy = add_fast_solvation_forces(
                    gas.topology, atoms, 1, gas.positions, pairs, forces, threads);
                const double force_error = worst_solvation_force(forces, expected.forces);
                const double energy_error =
                    std::abs(energy - expected.energy) / std::abs(expected.energy);
                CHECK(force_error <= 5e-6);
                CHECK(energy_error <= 1e-6);
                worst = std::max(worst, force_error);
                worst_energy = std::max(worst_energy, energy_error);
            }
        }
    }
    use_processor_kind(list_processor_kinds().front());
    fmt::print("solvation in single precision: force {:.2g}, energy {:.2g}\n", worst, worst_energy);
}

TEST_CASE("the list of solvation is right wherever the atoms go", "[forces][fast][solvation]") {
    HeavyGas gas = build_heavy_gas(300, 9, 2.2);
    const FastSolvationAtoms atoms = build_fast_solvation_atoms(gas.topology);
    std::mt19937 random(2);
    std::normal_distribution<double> velocity(0, 0.012);
    std::vector<Vec3> moves;
    for (std::size_t i = 0; i < gas.positions.size(); ++i) {
        const double x = velocity(random), y = velocity(random), z = velocity(random);
        moves.emplace_back(x, y, z);
    }
    FastSolvationPairs pairs;
    bool was_near = false;
    for (int step = 0; step < 90; ++step) {
        for (std::size_t i = 0; i < moves.size(); ++i)
            gas.positions[i] += (step < 60 ? 1 : -1) * moves[i];
        gas.positions[7].x() += step > 30 ? 0.2 : 0;
        std::vector<Vec3> forces(gas.positions.size(), Vec3::Zero());
        const double energy =
            add_fast_solvation_forces(gas.topology, atoms, 2, gas.positions, pairs, forces);
        const SolvationSum expected = sum_in_double(gas.topology, gas.positions);
        CHECK(energy == Approx(expected.energy).epsilon(1e-6));
        CHECK(worst_solvation_force(forces, expected.forces) <= 1e-5);
        was_near = was_near || !pairs.selected.empty();
    }
    CHECK(was_near);
}

TEST_CASE("atoms too close for single precision are summed in double",
          "[forces][fast][solvation]") {
    HeavyGas gas = build_heavy_gas(60, 5);
    gas.positions[20] = gas.positions[2];
    gas.positions[41] = gas.positions[33] + Vec3(0.3, 0, 0);
    const FastSolvationAtoms atoms = build_fast_solvation_atoms(gas.topology);
    FastSolvationPairs pairs;
    std::vector<Vec3> forces(gas.positions.size(), Vec3::Zero());

    const double energy =
        add_fast_solvation_forces(gas.topology, atoms, 1, gas.positions, pairs, forces);

    const SolvationSum expected = sum_in_double(gas.topology, gas.positions);
    CHECK(energy == Approx(expected.energy).epsilon(1e-12));
    CHECK(worst_solvation_force(forces, expected.forces) < 1e-12);
}

TEST_CASE("the whole force field of a solvated peptide in single precision",
          "[forces][fast][solvation]") {
    test::ReferenceCase peptide =
        test::read_reference_case(test::test_data("tetra_aera_c36m.ff.json"));
    std::vector<std::string> types;
    for (const test::ReferenceAtom& atom : peptide.atoms) types.push_back(atom.type);
    peptide.topology.solvation = test::solvation_of(types);
    const std::vector<Vec3> positions =
        test::read_reference_frames(test::test_data("tetra_aera_c36m.frames.json"))
            .front()
            .positions;
    const FastForceField fast = build_fast_force_field(peptide.topology);
    for (const SolvationEnd end : {SolvationEnd::Smooth, SolvationEnd::Sharp}) {
        const NonbondedSettings settings = eef1_settings(end);
        CHECK(has_fast_form(settings) == (end == SolvationEnd::Smooth));
        std::vector<Vec3> expected(positions.size(), Vec3::Zero());
        const EnergyTerms energy = add_forces(peptide.topology, settings, positions, expected);
        for (const std::size_t threads : {1U, 2U}) {
            FastPairs pairs;
            std::vector<Vec3> forces(positions.size(), Vec3::Zero());
            const EnergyTerms found =
                add_fast_forces(peptide.topology, fast, settings, 1, positions, pairs, forces,
                                PairResult::ForcesAndEnergies, threads);
            CHECK(found.solvation == Approx(energy.solvation).epsilon(1e-6));
            CHECK(found.total() == Approx(energy.total()).epsilon(1e-5));
            CHECK(worst_solvation_force(forces, expected) <= 5e-6);
        }
    }
}
