// Bonded terms many at a time against their reference, on every kind of processor.
#include "forces/fast_bonded.h"

#include "field/processor.h"
#include "forces/bonded.h"
#include "tests/support/check_forces.h"
#include "tests/support/paths.h"
#include "tests/support/reference_case.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

double worst_of(std::span<const Vec3> forces, std::span<const Vec3> reference) {
    double square = 0, worst = 0;
    for (const Vec3& force : reference) square += force.squaredNorm();
    const double rms = std::sqrt(square / static_cast<double>(reference.size()));
    for (std::size_t i = 0; i < reference.size(); ++i)
        worst =
            std::max(worst, (forces[i] - reference[i]).norm() / std::max(rms, reference[i].norm()));
    return worst;
}

// What no term's energy exceeds by far, wherever its atoms are a few Å apart.
double magnitude_of(const Topology& topology) {
    double sum = 1;
    for (const Dihedral& term : topology.dihedrals) sum += 2 * std::abs(term.k);
    return sum;
}

void check_against_reference(const Topology& topology, std::span<const Vec3> positions) {
    const FastBonded bonded = build_fast_bonded(topology);
    std::vector<Vec3> reference(topology.size(), Vec3::Zero());
    const double bond = add_bond_forces(topology.bonds, positions, reference);
    const double angle = add_angle_forces(topology.angles, positions, reference);
    const double urey_bradley =
        add_urey_bradley_forces(topology.urey_bradleys, positions, reference);
    const double dihedral = add_dihedral_forces(topology.dihedrals, positions, reference);
    const double improper = add_improper_forces(topology.impropers, positions, reference);
    for (const std::string& kind : list_processor_kinds()) {
        INFO(kind);
        use_processor_kind(kind);
        std::vector<Vec3> forces(topology.size(), Vec3::Zero());

        const BondedEnergy energy = add_fast_bonded_forces(bonded, positions, forces);

        CHECK(energy.bond == Approx(bond).epsilon(1e-12).margin(1e-12));
        CHECK(energy.angle == Approx(angle).epsilon(1e-12).margin(1e-12));
        CHECK(energy.urey_bradley == Approx(urey_bradley).epsilon(1e-12).margin(1e-12));
        CHECK(energy.dihedral ==
              Approx(dihedral).epsilon(0).margin(1e-12 * magnitude_of(topology)));
        CHECK(energy.improper == Approx(improper).epsilon(1e-12).margin(1e-12));
        CHECK(worst_of(forces, reference) <= 1e-12);
    }
    use_processor_kind(list_processor_kinds().front());
}

}  // namespace

TEST_CASE("a peptide's bonded terms are the reference's, at rest and torn apart",
          "[forces][bonded]") {
    const std::string name = GENERATE("ala_dipeptide", "tetra_aera_c36m");
    const std::string path = test::test_data(name);
    const test::ReferenceCase reference = test::read_reference_case(path + ".ff.json");
    std::vector<Vec3> positions = test::read_reference_frames(path + ".frames.json")[0].positions;
    const double shake = GENERATE(0.0, 0.3, 1.5);  // Å
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-shake, shake);
    for (Vec3& place : positions) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        place += Vec3(x, y, z);
    }

    check_against_reference(reference.topology, positions);
}

TEST_CASE("dihedrals of any multiplicity and phase are the reference's, from either end",
          "[forces][bonded]") {
    Topology topology;
    topology.charge.assign(4, 0);
    topology.dihedrals = {{0, 1, 2, 3, 1, 0.8, 0},
                          {3, 2, 1, 0, 2, 2.5, std::numbers::pi},
                          {0, 1, 2, 3, 6, 0.3, 0.4},
                          {0, 2, 1, 3, 9, 0.7, -1},
                          {0, 1, 2, 3, 6, 0.2, 2}};
    topology.impropers = {{0, 1, 2, 3, 40, 0.6}, {1, 0, 2, 3, 30, -3}};
    CHECK(build_fast_bonded(topology).dihedrals.atoms.size() == 2);
    std::mt19937 random(3);
    for (int round = 0; round < 50; ++round)
        check_against_reference(topology, test::random_positions(random, 4, 1.5, 0.8));
}

TEST_CASE("dihedrals with three atoms almost in line are the reference's, at either end or both",
          "[forces][bonded]") {
    // How far off the line a and d are, Å: normals beside torsion_guard, 0.005 Å^2.
    const double of_a = GENERATE(1e-5, 1e-3, 0.002, 0.01, 1.0), of_d = GENERATE(1e-4, 0.002, 1.0);
    INFO(of_a << " and " << of_d << " Å off the line");
    Topology topology;
    topology.charge.assign(4, 0);
    topology.dihedrals = {{0, 1, 2, 3, 3, 1.2, 0.5}};
    topology.impropers = {{0, 1, 2, 3, 20, 0.3}};
    const std::vector<Vec3> positions{
        {-1.5, of_a, 0}, {0, 0, 0}, {1.5, 0, 0}, {3, 0.6 * of_d, 0.8 * of_d}};

    check_against_reference(topology, positions);
}

TEST_CASE("more terms than a block holds count once each", "[forces][bonded]") {
    constexpr std::uint32_t count = 2 * block_size + 3;
    Topology topology;
    topology.charge.assign(count + 1, 0);
    std::mt19937 random(4);
    const std::vector<Vec3> positions = test::random_positions(random, count + 1, 6, 0.8);
    for (std::uint32_t i = 0; i < count; ++i) {
        topology.bonds.push_back({i, i + 1, 100.0 + i, 1.5});
        topology.angles.push_back({i, i + 1, (i + 2) % count, 40.0 + i, 0.03 * i / 2});
    }
    topology.angles.pop_back();  // its first and last atom are one

    check_against_reference(topology, positions);
}
