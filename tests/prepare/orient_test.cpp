#include "prepare/orient.h"

#include "forces/force_field.h"
#include "formats/pdb.h"
#include "tests/prepare/molecules.h"
#include "tests/support/shared_data.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
using namespace palpa::test;

namespace {

using Kind = OrientedGroup::Kind;

// Charges, one plain Lennard-Jones type for heavy atoms and one for hydrogens, exclusions.
void finish(Molecule& molecule, const std::vector<double>& charge) {
    Topology& topology = molecule.topology;
    topology.charge = charge;
    for (const double mass : molecule.connectivity.mass) topology.type.push_back(mass < 2 ? 1 : 0);
    const std::vector<LennardJonesType> types{{0.12, 1.7}, {0.046, 0.2245}};
    topology.lennard_jones = topology.lennard_jones14 = build_lennard_jones_table(types, {});
    topology.exclusions = build_exclusions(topology.bonds, charge.size());
}

std::vector<std::uint32_t> build_hydrogens(Molecule& molecule) {
    std::vector<std::uint32_t> built;
    for (const PlacedAtom& atom : molecule.build().placed) built.push_back(atom.atom);
    return built;
}

double total(const Topology& topology, const std::vector<Vec3>& positions) {
    std::vector<Vec3> forces(positions.size(), Vec3::Zero());
    return add_forces(topology, nonbonded_settings({}), positions, forces).total();
}

}  // namespace

TEST_CASE("a hydroxyl beside a carbonyl oxygen points at it", "[prepare][orient]") {
    // C-C-O-H, the C-O bond along x; the acceptor 2.8 Å off where the angle of 106 degree lets H
    // reach, at any turn about the bond.
    const double turn = GENERATE(-150.0, -37.0, 64.0, 171.0) * degree;
    Molecule molecule;
    const std::uint32_t c0 = molecule.add(carbon, {-1.9, 1.4, 0});
    const std::uint32_t c1 = molecule.add(carbon, {-1.42, 0, 0});
    const std::uint32_t o = molecule.add(oxygen, {0, 0, 0}), h = molecule.add(hydrogen);
    const Vec3 there(std::cos(74 * degree), std::sin(74 * degree) * std::cos(turn),
                     std::sin(74 * degree) * std::sin(turn));
    const std::uint32_t acceptor = molecule.add(oxygen, 2.8 * there);
    const std::uint32_t carbonyl = molecule.add(carbon, 4.03 * there);
    molecule.bond(c0, c1, 1.5);
    molecule.bond(c1, o, 1.42);
    molecule.bond(o, h, 0.96);
    molecule.bond(acceptor, carbonyl, 1.23);
    molecule.angle(c1, o, h, 106);
    finish(molecule, {0, 0.23, -0.66, 0.43, -0.51, 0.51});
    const std::vector<std::uint32_t> built = build_hydrogens(molecule);
    const double before = total(molecule.topology, molecule.positions);

    const OrientReport report =
        orient_groups(molecule.connectivity, molecule.topology, built, {}, molecule.positions);

    CHECK(molecule.angle_deg(h, o, acceptor) < 3);
    CHECK(molecule.length(o, h) == Approx(0.96).epsilon(1e-9));
    CHECK(molecule.angle_deg(c1, o, h) == Approx(106).epsilon(1e-9));
    REQUIRE(report.groups.size() == 1);
    CHECK(report.groups[0].kind == Kind::Rotor);
    CHECK(report.groups[0].atom == o);
    CHECK(report.groups[0].dihedral_after / degree ==
          Approx(molecule.dihedral_deg(c0, c1, o, h)).margin(1e-9));
    CHECK(report.energy_change ==
          Approx(total(molecule.topology, molecule.positions) - before).margin(1e-9));
}

TEST_CASE("a hydroxyl whose hydrogen was given stays", "[prepare][orient]") {
    Molecule molecule;
    const std::uint32_t c = molecule.add(carbon, {-1.42, 0, 0});
    const std::uint32_t o = molecule.add(oxygen, {0, 0, 0});
    const std::uint32_t h = molecule.add(hydrogen, {0.3, -0.9, 0});
    molecule.add(oxygen, {0.7, 2.7, 0});
    molecule.bond(c, o, 1.42);
    molecule.bond(o, h, 0.96);
    finish(molecule, {0.23, -0.66, 0.43, -0.5});
    const std::vector<Vec3> given = molecule.positions;

    const OrientReport report =
        orient_groups(molecule.connectivity, molecule.topology, {}, {}, molecule.positions);

    CHECK(report.groups.empty());
    CHECK(molecule.positions == given);
}

TEST_CASE("a water between an anion and a cation is turned to its lowest energy",
          "[prepare][orient]") {
    Molecule molecule;
    const std::uint32_t o = molecule.add(oxygen, {0, 0, 0});
    const std::uint32_t h1 = molecule.add(hydrogen), h2 = molecule.add(hydrogen);
    const Vec3 there = Vec3(1, -2, 2) / 3;
    molecule.add(oxygen, 2.8 * there);
    molecule.add(carbon, -2.8 * there);
    molecule.bond(o, h1, 0.9572);
    molecule.bond(o, h2, 0.9572);
    molecule.bond(h1, h2, 1.5139);
    molecule.angle(h1, o, h2, 104.52);
    finish(molecule, {-0.834, 0.417, 0.417, -1, 1});
    const std::vector<std::uint32_t> built = build_hydrogens(molecule);

    const OrientReport report =
        orient_groups(molecule.connectivity, molecule.topology, built, {}, molecule.positions);

    REQUIRE(report.groups.size() == 1);
    CHECK(report.groups[0].kind == Kind::Water);
    CHECK(molecule.length(o, h1) == Approx(0.9572).epsilon(1e-9));
    CHECK(molecule.angle_deg(h1, o, h2) == Approx(104.52).epsilon(1e-9));
    // No other orientation is better: of many taken at random, and of those near by.
    const double found = total(molecule.topology, molecule.positions);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const std::vector<Vec3> there_now = molecule.positions;
    double best = found;
    for (int i = 0; i < 20000; ++i) {
        const double spread = i % 2 ? 1 : 0.02;
        const Eigen::Quaterniond rotation =
            Eigen::Quaterniond(i % 2 ? normal(random) : 1, spread * normal(random),
                               spread * normal(random), spread * normal(random))
                .normalized();
        for (const std::uint32_t atom : {h1, h2}) {
            molecule.positions[atom] = rotation * there_now[atom];
        }
        best = std::min(best, total(molecule.topology, molecule.positions));
    }
    CHECK(found - best < 0.01);
}

TEST_CASE("turning the groups of 1TW7 lowers its energy as reported, the same way each time",
          "[prepare][orient][native]") {
    const auto file = find_shared_data("data/hiv/1tw7_charmm_allH.pdb");
    if (!file) return;
    const Structure structure = read_pdb(*file);
    const Typed typed = type_1tw7(*file, structure);
    std::vector<Vec3> positions = structure.positions;
    std::vector<std::uint32_t> built;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (!is_hydrogen(typed.connectivity, i)) continue;
        positions[i] = nowhere;
        built.push_back(i);
    }
    build_positions(typed.connectivity, typed.topology, typed.coordinates, positions);
    const std::vector<Vec3> start = positions;

    const OrientReport report =
        orient_groups(typed.connectivity, typed.topology, built, {}, positions);

    std::map<Kind, int> kinds;
    for (const OrientedGroup& group : report.groups) ++kinds[group.kind];
    // Counted in the file: 20 hydroxyls, those of two Asp among them, 4 thiols, 12 Lys.
    CHECK(kinds[Kind::Water] == 0);
    CHECK(kinds[Kind::Rotor] == 36);
    CHECK(report.is_settled);
    const double before = total(typed.topology, start), after = total(typed.topology, positions);
    std::cout << fmt::format("1TW7: {} groups, {} sweeps, {:.1f} kcal/mol\n", report.groups.size(),
                             report.sweeps, after - before);
    CHECK(report.energy_change < 0);
    CHECK(after - before == Approx(report.energy_change).margin(1e-6));
    for (const Bond& bond : typed.topology.bonds) {
        CHECK((positions[bond.a] - positions[bond.b]).norm() ==
              Approx((start[bond.a] - start[bond.b]).norm()).margin(1e-9).epsilon(0));
    }

    std::vector<Vec3> again = start;
    orient_groups(typed.connectivity, typed.topology, built, {}, again);
    CHECK(again == positions);

    for (std::uint32_t i = 0; i < start.size(); ++i) {
        if (!is_hydrogen(typed.connectivity, i)) CHECK(positions[i] == start[i]);
    }
}
