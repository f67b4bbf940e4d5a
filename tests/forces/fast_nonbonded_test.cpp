// Single precision against its reference in double: every scheme, every kind of processor.
#include "forces/fast_nonbonded.h"

#include "field/processor.h"
#include "forces/force_field.h"
#include "forces/pair_law.h"
#include "tests/support/check_forces.h"
#include "tests/support/paths.h"
#include "tests/support/reference_case.h"
#include "tests/support/shared_data.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
namespace fs = std::filesystem;

namespace {

constexpr double skin = 1;

std::vector<NonbondedSettings> all_schemes() {
    std::vector<NonbondedSettings> schemes;
    using Electrostatics = ElectrostaticCutoff;
    using VanDerWaals = VanDerWaalsCutoff;
    for (const bool distance_dielectric : {false, true}) {
        schemes.push_back({.coulomb_constant = test::reference_coulomb_constant,
                           .distance_dielectric = distance_dielectric});
    }
    schemes.push_back({.coulomb_constant = test::reference_coulomb_constant,
                       .electrostatics = Electrostatics::ForceSwitch,
                       .van_der_waals = VanDerWaals::ForceSwitch});
    for (const bool distance_dielectric : {false, true}) {
        schemes.push_back({.coulomb_constant = test::reference_coulomb_constant,
                           .distance_dielectric = distance_dielectric,
                           .electrostatics = Electrostatics::CubicShift,
                           .van_der_waals = VanDerWaals::SmoothSwitch,
                           .switch_from = 7,
                           .cutoff = 9});
    }
    return schemes;
}

// The reference's sums, and what their errors are measured by.
struct Expected {
    NonbondedEnergy energy, magnitude;
    std::vector<Vec3> forces;
    double rms_force = 0;
};

// Repulsion, attraction and the electrostatic energy of each pair, all positive.
NonbondedEnergy sum_magnitudes(const Topology& topology, const NonbondedSettings& settings,
                               std::span<const Vec3> positions) {
    return with_law(settings, [&](const auto& law) {
        NonbondedEnergy sum;
        for (std::uint32_t i = 0; i < topology.size(); ++i) {
            const auto excluded = topology.exclusions.of(i);
            for (std::uint32_t j = i + 1; j < topology.size(); ++j) {
                const double r2 = (positions[i] - positions[j]).squaredNorm();
                if (r2 >= law.reach2) continue;
                if (std::binary_search(excluded.begin(), excluded.end(), j)) continue;
                const LennardJonesPair& lj =
                    topology.lennard_jones.row(topology.type[i])[topology.type[j]];
                const double charges =
                    settings.coulomb_constant * topology.charge[i] * topology.charge[j];
                const double s2 = lj.rmin * lj.rmin / r2, s6 = s2 * s2 * s2;
                sum.van_der_waals += lj.epsilon * (s6 * s6 + 2 * s6);
                sum.electrostatic +=
                    std::abs(law.evaluate(r2, 1 / std::sqrt(r2), charges, lj).electrostatic.energy);
            }
        }
        return sum;
    });
}

double rms_of(const std::vector<Vec3>& forces) {
    double sum = 0;
    for (const Vec3& force : forces) sum += force.squaredNorm();
    return std::sqrt(sum / static_cast<double>(forces.size()));
}

Expected expect(const Topology& topology, const NonbondedSettings& settings,
                std::span<const Vec3> positions) {
    Expected expected{{}, sum_magnitudes(topology, settings, positions), {}};
    expected.forces.assign(topology.size(), Vec3::Zero());
    expected.energy = add_nonbonded_forces(topology, settings, positions, expected.forces);
    expected.rms_force = rms_of(expected.forces);
    return expected;
}

// Largest errors found: energies relative to the sum of all pairs' magnitudes, forces to the larger
// of the atom's own and the rms force.
struct Worst {
    double van_der_waals = 0, electrostatic = 0, force = 0;
};

void check_against(const Expected& expected, const NonbondedEnergy& energy,
                   const std::vector<Vec3>& forces, Worst& worst) {
    const auto relative = [](double error, double scale) {
        return scale > 0 ? std::abs(error) / scale : std::abs(error);
    };
    const double lj_error = energy.van_der_waals - expected.energy.van_der_waals;
    const double coulomb_error = energy.electrostatic - expected.energy.electrostatic;
    const double van_der_waals = relative(lj_error, expected.magnitude.van_der_waals);
    const double electrostatic = relative(coulomb_error, expected.magnitude.electrostatic);
    const double total = relative(lj_error + coulomb_error, expected.magnitude.van_der_waals +
                                                                expected.magnitude.electrostatic);
    double force = 0;
    for (std::size_t i = 0; i < forces.size(); ++i) {
        force = std::max(force, relative((forces[i] - expected.forces[i]).norm(),
                                         std::max(expected.rms_force, expected.forces[i].norm())));
    }
    CHECK(total <= 1e-6);
    // In r^-12 a rounding of single precision, 6e-8, counts twelvefold; a single pair can have
    // several of them on one side.
    CHECK(van_der_waals <= 2e-6);
    CHECK(electrostatic <= 1e-6);
    CHECK(force <= 2e-5);
    worst.van_der_waals = std::max(worst.van_der_waals, van_der_waals);
    worst.electrostatic = std::max(worst.electrostatic, electrostatic);
    worst.force = std::max(worst.force, force);
}

void check_forces(const Expected& expected, const std::vector<Vec3>& forces) {
    for (std::size_t i = 0; i < forces.size(); ++i) {
        CHECK((forces[i] - expected.forces[i]).norm() <=
              2e-5 * std::max(expected.rms_force, expected.forces[i].norm()));
    }
}

void check_positions(const Topology& topology, const FastAtoms& atoms,
                     std::span<const Vec3> positions, const std::vector<std::string>& kinds,
                     Worst& worst) {
    for (const NonbondedSettings& settings : all_schemes()) {
        const Expected expected = expect(topology, settings, positions);
        for (const std::string& kind : kinds) {
            INFO(fmt::format("electrostatics {}, van der Waals {}, dielectric {}, {}",
                             static_cast<int>(settings.electrostatics),
                             static_cast<int>(settings.van_der_waals),
                             settings.distance_dielectric ? "eps r" : "eps", kind));
            use_processor_kind(kind);
            FastPairs pairs;
            std::vector<Vec3> forces(topology.size(), Vec3::Zero());
            const NonbondedEnergy energy =
                add_fast_nonbonded_forces(topology, atoms, settings, skin, positions, pairs, forces,
                                          PairResult::ForcesAndEnergies);
            check_against(expected, energy, forces, worst);
            std::vector<Vec3> forces_alone(topology.size(), Vec3::Zero());
            add_fast_nonbonded_forces(topology, atoms, settings, skin, positions, pairs,
                                      forces_alone, PairResult::Forces, {2});
            check_against(expected, energy, forces_alone, worst);
        }
    }
    use_processor_kind(kinds.front());
}

// All terms, against another program's energies and forces. The error is measured by the forces of
// the plain pairs, which are those in single precision: at rest the whole force on an atom is
// small.
void check_frame(const Topology& topology, const FastForceField& fast,
                 const test::ReferenceFrame& frame, Worst& worst) {
    const NonbondedSettings settings{.coulomb_constant = test::reference_coulomb_constant};
    Expected expected = expect(topology, settings, frame.positions);
    expected.energy = {frame.energy.at("lj"), frame.energy.at("coulomb")};
    double others = 0, largest = 0;
    for (const auto& [term, energy] : frame.energy) {
        if (term == "lj" || term == "coulomb" || term == "total") continue;
        others += energy;
        largest = std::max(largest, std::abs(energy));
    }
    for (const std::string& kind : list_processor_kinds()) {
        for (const std::size_t threads : {1U, 2U}) {
            INFO(kind << ", " << threads << " threads");
            use_processor_kind(kind);
            FastPairs pairs;
            std::vector<Vec3> forces(topology.size(), Vec3::Zero());
            const EnergyTerms energy =
                add_fast_forces(topology, fast, settings, skin, frame.positions, pairs, forces,
                                PairResult::ForcesAndEnergies, threads);
            for (std::size_t i = 0; i < forces.size(); ++i)
                forces[i] += expected.forces[i] - frame.forces[i];
            check_against(expected, {energy.lj, energy.coulomb}, forces, worst);
            EnergyTerms without_pairs = energy;
            without_pairs.lj = without_pairs.coulomb = 0;
            CHECK(std::abs(without_pairs.total() - others) <= 1e-9 * largest);
        }
    }
    use_processor_kind(list_processor_kinds().front());
}

void check_case(const fs::path& folder, const std::string& name, const std::string& frames) {
    INFO(name << " " << frames);
    const test::ReferenceCase reference = test::read_reference_case(folder / (name + ".ff.json"));
    const FastAtoms atoms = build_fast_atoms(reference.topology);
    const FastForceField fast = build_fast_force_field(reference.topology);
    Worst worst, worst_held;
    for (const auto& frame :
         test::read_reference_frames(folder / fmt::format("{}.{}.json", name, frames))) {
        INFO(frame.name);
        check_positions(reference.topology, atoms, frame.positions, list_processor_kinds(), worst);
        check_frame(reference.topology, fast, frame, worst_held);
    }
    fmt::print(
        "{} {}: van der Waals {:.2g}, electrostatic {:.2g}, force {:.2g}; held force {:.2g}\n",
        name, frames, worst.van_der_waals, worst.electrostatic, worst.force, worst_held.force);
}

// Ions without a bond; two types have NBFIX numbers together.
Topology build_salt(std::size_t count) {
    Topology topology;
    for (std::uint32_t i = 0; i < count; ++i) {
        topology.type.push_back(i % 3);
        topology.charge.push_back(i % 3 == 0 ? 1 : -0.5);
    }
    const std::vector<LennardJonesType> types{{0.0469, 1.41}, {0.15, 2.27}, {0.1, 1.9}};
    const std::vector<Nbfix> nbfix{{0, 1, {0.083875, 3.731}}};
    topology.lennard_jones = build_lennard_jones_table(types, nbfix);
    topology.lennard_jones14 = topology.lennard_jones;
    topology.exclusions = build_exclusions({}, count);
    return topology;
}

}  // namespace

TEST_CASE("single precision agrees with the reference and the held forces of small cases",
          "[forces][fast]") {
    const fs::path folder(test::test_data(""));
    check_case(folder, "ala_dipeptide", "frames");
    check_case(folder, "tetra_aera_c36m", "frames");
}

TEST_CASE("single precision agrees with the reference and the held forces of every case",
          "[forces][fast][long]") {
    const auto folder = test::find_shared_data("reference");
    if (!folder) return;
    check_case(*folder, "water_dimer_charmm", "frames");
    check_case(*folder, "water_dimer_standard", "frames");
    check_case(*folder, "tetra_adka_c36m", "frames");
    check_case(*folder, "tetra_ampa_c36m", "frames");
    const auto frame = [&](const std::string& name, const std::vector<std::string>& frames) {
        for (const std::string& each : frames) check_case(*folder, name, each);
    };
    frame("crambin_c36m",
          {"input", "minimised_300_steps", "minimised_noise0.003nm_3", "minimised_noise0.005nm_2"});
    frame("ubiquitin", {"pdb_plus_built_hydrogens", "minimised_300_steps", "minimised_noise0.005nm",
                        "pdb_noise0.003nm"});
    frame("hiv_protease_1hpv", {"pdb_plus_built_hydrogens", "minimised_300_steps",
                                "minimised_noise0.002nm", "minimised_noise0.003nm"});
    frame("hiv_tl3_c36m",
          {"input", "minimised_300_steps", "minimised_noise0.003nm_3", "minimised_noise0.005nm_2"});
}

TEST_CASE("pairs of replaced numbers count with them, and once", "[forces][fast]") {
    const Topology topology = build_salt(90);
    std::mt19937 random(4);
    const std::vector<Vec3> positions = test::random_positions(random, 90, 9, 2.2);
    const FastAtoms atoms = build_fast_atoms(topology);
    Worst worst;

    CHECK(atoms.replaced().size() == 900);
    check_positions(topology, atoms, positions, list_processor_kinds(), worst);
}

TEST_CASE("the list is updated when outdated, and not before", "[forces][fast]") {
    const Topology topology = build_salt(90);
    std::mt19937 random(5);
    std::vector<Vec3> positions = test::random_positions(random, 90, 9, 2.5);
    const FastAtoms atoms = build_fast_atoms(topology);
    const NonbondedSettings settings{.electrostatics = ElectrostaticCutoff::ForceSwitch,
                                     .van_der_waals = VanDerWaalsCutoff::ForceSwitch,
                                     .switch_from = 5,
                                     .cutoff = 6};
    FastPairs pairs;

    for (int step = 0; step < 40; ++step) {
        positions[7].x() += 0.1;
        std::vector<Vec3> forces(90, Vec3::Zero());
        add_fast_nonbonded_forces(topology, atoms, settings, skin, positions, pairs, forces,
                                  PairResult::Forces);
        check_forces(expect(topology, settings, positions), forces);
    }

    // 3.9 Å in pieces of 0.5 to 0.6 Å.
    CHECK(pairs.builds + pairs.updates >= 7);
    CHECK(pairs.builds + pairs.updates <= 9);
    CHECK(pairs.updates >= 5);
    CHECK(pairs.in_double == 0);
    // Of 900 pairs with replaced numbers those that are near, and some that were not long ago.
    const auto near = std::ranges::count_if(atoms.replaced(), [&](const auto& pair) {
        return (positions[pair[0]] - positions[pair[1]]).norm() < 6;
    });
    CHECK(near > 0);
    CHECK(pairs.replaced.size() >= static_cast<std::size_t>(near));
    CHECK(pairs.replaced.size() < 900);
}

TEST_CASE("what is near of a list is found again before it is outdated", "[forces][fast]") {
    const Topology topology = build_salt(300);
    std::mt19937 random(8);
    std::vector<Vec3> positions = test::random_positions(random, 300, 16, 2.2);
    const FastAtoms atoms = build_fast_atoms(topology);
    const NonbondedSettings settings{.electrostatics = ElectrostaticCutoff::ForceSwitch,
                                     .van_der_waals = VanDerWaalsCutoff::ForceSwitch,
                                     .switch_from = 4.5,  // so that no near pair is missed
                                     .cutoff = 5};
    std::normal_distribution<double> velocity(0, 0.015);
    std::vector<Vec3> moves;
    for (int i = 0; i < 300; ++i)
        moves.emplace_back(velocity(random), velocity(random), velocity(random));
    FastPairs pairs;
    std::size_t found = 0;
    Vec3 last = Vec3::Zero();

    for (int step = 0; step < 60; ++step) {
        for (std::size_t i = 0; i < 300; ++i) positions[i] += (step < 40 ? 1 : -1) * moves[i];
        std::vector<Vec3> forces(300, Vec3::Zero());
        add_fast_nonbonded_forces(topology, atoms, settings, 2, positions, pairs, forces,
                                  PairResult::Forces);
        check_forces(expect(topology, settings, positions), forces);
        if (pairs.near.selected.empty() || pairs.near.selected[0] == last) continue;
        ++found;
        last = pairs.near.selected[0];
    }

    CHECK(found > 2);
    CHECK(found < 30);
    CHECK(pairs.near.tiles.skin == 0.6);
}

TEST_CASE("what has no kernel in single precision is the reference's to the bit",
          "[forces][fast]") {
    const Topology topology = build_salt(30);
    std::mt19937 random(6);
    std::vector<Vec3> positions = test::random_positions(random, 30, 9, 2.5);
    NonbondedSettings settings;
    SECTION("switched forces of a dielectric that grows with the distance") {
        settings.distance_dielectric = true;
        settings.electrostatics = ElectrostaticCutoff::ForceSwitch;
        settings.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
    }
    SECTION("other cutoffs") {
        settings.electrostatics = GENERATE(
            ElectrostaticCutoff::None, ElectrostaticCutoff::Switch, ElectrostaticCutoff::Shift,
            ElectrostaticCutoff::ForceShift, ElectrostaticCutoff::ForceSwitch);
        settings.van_der_waals = VanDerWaalsCutoff::Switch;
    }
    SECTION("two atoms at one place") { positions[2] = positions[1]; }
    SECTION("an atom far off") { positions[2].z() = 1e7; }

    const FastAtoms atoms = build_fast_atoms(topology);
    FastPairs pairs;
    std::vector<Vec3> forces(30, Vec3::Zero()), expected(30, Vec3::Zero());
    const NonbondedEnergy energy = add_fast_nonbonded_forces(
        topology, atoms, settings, skin, positions, pairs, forces, PairResult::ForcesAndEnergies);
    const NonbondedEnergy reference = add_nonbonded_forces(topology, settings, positions, expected);

    CHECK(energy.van_der_waals == reference.van_der_waals);
    CHECK(energy.electrostatic == reference.electrostatic);
    CHECK(forces == expected);
    CHECK(pairs.in_double == 1);
}
