#include "forces/solvation.h"

#include "field/pair_field.h"
#include "forces/force_field.h"
#include "forces/solvation_law.h"
#include "tests/support/check_forces.h"
#include "tests/support/paths.h"
#include "tests/support/solvation_of.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// A case of tests/data/solvent.
struct SolventCase {
    std::string name;
    double total = 0;  // kcal/mol
    std::vector<std::string> types;
    std::vector<Vec3> positions;
    std::vector<double> numbers;
    std::vector<Bond> bonds;
};

std::vector<SolventCase> read_solvent_cases(const std::string& file) {
    std::vector<SolventCase> cases;
    std::ifstream lines(test::test_data("solvent/" + file));
    std::string line, word;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        words >> word;
        if (word == "case") {
            SolventCase& c = cases.emplace_back();
            words >> c.name >> c.total;
        } else if (word == "atom") {
            SolventCase& c = cases.back();
            words >> c.types.emplace_back();
            Vec3& at = c.positions.emplace_back();
            words >> at.x() >> at.y() >> at.z() >> c.numbers.emplace_back();
        } else if (word == "bond") {
            Bond bond{};
            words >> bond.a >> bond.b;
            cases.back().bonds.push_back(bond);
        }
    }
    return cases;
}

// Without charges and Lennard-Jones.
Topology topology_of(const SolventCase& c, const Solvation& solvation) {
    Topology topology;
    topology.charge.assign(c.types.size(), 0);
    topology.type.assign(c.types.size(), 0);
    topology.lennard_jones = {1, {{0, 1}}};
    topology.lennard_jones14 = topology.lennard_jones;
    topology.exclusions = build_exclusions(c.bonds, c.types.size());
    topology.solvation = solvation;
    return topology;
}

std::vector<std::array<std::uint32_t, 2>> list_pairs(const Topology& topology) {
    std::vector<std::array<std::uint32_t, 2>> pairs = topology.exclusions.pairs14;
    for (std::uint32_t i = 0; i < topology.size(); ++i) {
        const auto excluded = topology.exclusions.of(i);
        for (std::uint32_t j = i + 1; j < topology.size(); ++j) {
            if (!std::binary_search(excluded.begin(), excluded.end(), j)) pairs.push_back({i, j});
        }
    }
    return pairs;
}

std::vector<double> atom_energies(const Topology& topology, const std::vector<Vec3>& positions,
                                  const SolvationLaw<>& law) {
    std::vector<double> energies = topology.solvation->dg_ref;
    for (const auto& [i, j] : list_pairs(topology)) {
        const SolvationPair pair = law.evaluate((positions[i] - positions[j]).squaredNorm(),
                                                solvation_atom(*topology.solvation, i),
                                                solvation_atom(*topology.solvation, j));
        energies[i] += pair.energy_a;
        energies[j] += pair.energy_b;
    }
    return energies;
}

double sum_of(const std::vector<double>& energies) {
    double sum = 0;
    for (const double energy : energies) sum += energy;
    return sum;
}

// Atoms of several types, some of them hydrogens, and a chain of bonds among the first.
struct SolvatedGas {
    Topology topology;
    std::vector<Vec3> positions;
};

SolvatedGas build_solvated_gas(std::size_t count, double spread, std::uint32_t seed) {
    const std::array<std::string, 6> kinds{"NH3", "OC", "CT3", "H", "CT2", "CA"};
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    SolvatedGas gas;
    std::vector<std::string> types;
    for (std::size_t i = 0; i < count; ++i) {
        types.push_back(kinds[i % kinds.size()]);
        gas.topology.charge.push_back(0.6 * uniform(random));
        gas.topology.type.push_back(static_cast<std::uint32_t>(i % 3));
    }
    const std::vector<LennardJonesType> numbers{{0.15, 1.2}, {0.05, 0.9}, {0.1, 1}};
    gas.topology.lennard_jones = build_lennard_jones_table(numbers, {});
    gas.topology.lennard_jones14 = gas.topology.lennard_jones;
    std::vector<Bond> bonds;
    for (std::uint32_t i = 0; i < 9; ++i) bonds.push_back({i, i + 1, 0, 0});
    gas.topology.exclusions = build_exclusions(bonds, count);
    gas.topology.solvation = test::solvation_of(types);
    gas.positions = test::random_positions(random, count, spread, 1.7);
    return gas;
}

// Two atoms along x.
struct SolvatedPair {
    Topology topology;

    explicit SolvatedPair(const std::string& a, const std::string& b) {
        topology.charge = {0.6, -0.4};
        topology.type = {0, 0};
        topology.lennard_jones = {1, {{0.1, 3.6}}};
        topology.lennard_jones14 = topology.lennard_jones;
        topology.exclusions.first = {0, 0, 0};
        topology.solvation = test::solvation_of(std::array{a, b});
    }

    // Energy and the force that pushes them apart.
    std::array<double, 2> at(double r, const NonbondedSettings& settings) const {
        const std::vector<Vec3> positions{{r, 0, 0}, {0, 0, 0}};
        std::vector<Vec3> forces(2, Vec3::Zero());
        const NonbondedEnergy energy = add_nonbonded_forces(topology, settings, positions, forces);
        return {energy.sum(), forces[0].x()};
    }
};

}  // namespace

TEST_CASE("proteins have the solvation that CHARMM gives each of their atoms",
          "[forces][solvation]") {
    for (const char* name : {"protein_g", "ff_domain", "top7", "apo_lfabp", "rhodopsin"}) {
        INFO(name);
        const std::vector<SolventCase> cases = read_solvent_cases(std::string(name) + ".txt");
        REQUIRE(cases.size() == 1);
        const SolventCase& c = cases.front();
        const Topology topology = topology_of(c, test::solvation_of(c.types));

        const std::vector<double> energies = find_solvation_energies(
            topology, SolvationEnd::Sharp, c.positions, SolvationExponential::Table);

        CHECK(sum_of(energies) == Approx(c.total).margin(1e-5).epsilon(0));
        double worst = 0;
        for (std::size_t i = 0; i < energies.size(); ++i)
            worst = std::max(worst, std::abs(energies[i] - c.numbers[i]));
        CHECK(worst <= 5e-4 * (1 + 1e-6));  // all that is printed

        // What its table of the exponential and its sharp end make.
        const double exact =
            sum_of(find_solvation_energies(topology, SolvationEnd::Sharp, c.positions));
        CHECK(exact == Approx(c.total).margin(0.1).epsilon(0));
        CHECK(exact == Approx(sum_of(atom_energies(topology, c.positions,
                                                   SolvationLaw<>(SolvationEnd::Sharp))))
                           .epsilon(1e-13));
        CHECK(sum_of(find_solvation_energies(topology, SolvationEnd::Smooth, c.positions)) ==
              Approx(exact).epsilon(2e-4));
    }
}

TEST_CASE("tetrapeptides have CHARMM's solvation", "[forces][solvation]") {
    const std::vector<SolventCase> cases = read_solvent_cases("tetrapeptides.txt");
    REQUIRE(cases.size() == 38);
    for (const SolventCase& c : cases) {
        INFO(c.name);
        const Topology topology = topology_of(c, test::solvation_of(c.types));

        CHECK(sum_of(find_solvation_energies(topology, SolvationEnd::Sharp, c.positions,
                                             SolvationExponential::Table)) ==
              Approx(c.total).margin(1e-5).epsilon(0));
    }
}

TEST_CASE("GENESIS agrees on solvation at 300 K and on a dielectric of r", "[forces][solvation]") {
    const std::vector<SolventCase> cases = read_solvent_cases("genesis_1afo.txt");
    REQUIRE(cases.size() == 1);
    const SolventCase& c = cases.front();
    Topology topology = topology_of(c, test::solvation_of(c.types, "eef1_1999.csv", 300));
    topology.charge = c.numbers;
    std::vector<Vec3> forces(topology.size(), Vec3::Zero());

    // -558.68221 to five digits, of which GENESIS prints four.
    CHECK(sum_of(find_solvation_energies(topology, SolvationEnd::Sharp, c.positions)) ==
          Approx(-558.68221).margin(1e-5).epsilon(0));
    CHECK(c.total == Approx(-558.68221).margin(5e-5).epsilon(0));
    std::vector<std::array<std::uint32_t, 2>> pairs = list_pairs(topology);
    std::erase_if(pairs, [&](const auto& pair) {
        return (c.positions[pair[0]] - c.positions[pair[1]]).norm() >= 50;
    });
    CHECK(add_pair_forces(topology, {.distance_dielectric = true}, pairs, c.positions, forces)
              .electrostatic == Approx(-114.1989).margin(5e-5).epsilon(0));
}

TEST_CASE("solvation is the sum of what each atom has, whichever way it is summed",
          "[forces][solvation]") {
    const auto end = GENERATE(SolvationEnd::Sharp, SolvationEnd::Smooth);
    const SolvatedGas gas = build_solvated_gas(90, 11, 5);
    const NonbondedSettings settings = eef1_settings(end);
    const auto sum = [&](const NonbondedSettings& of) {
        std::vector<Vec3> forces(gas.positions.size(), Vec3::Zero());
        return std::pair(add_forces(gas.topology, of, gas.positions, forces), forces);
    };
    const auto [energy, forces] = sum(settings);
    const auto [vacuum, vacuum_forces] = sum(eef1_settings(SolvationEnd::None));

    CHECK(energy.solvation ==
          Approx(sum_of(find_solvation_energies(gas.topology, end, gas.positions))).epsilon(1e-12));
    CHECK(vacuum.solvation == 0);
    CHECK(energy.total() - vacuum.total() == Approx(energy.solvation).epsilon(1e-10));
    CHECK(energy.magnitude() == Approx(vacuum.magnitude() + std::abs(energy.solvation)));

    CHECK(find_reach(settings) == (end == SolvationEnd::Smooth ? 9.5 : 9));
    const PairList list =
        build_pair_list(gas.topology.exclusions, find_reach(settings), 1, gas.positions);
    for (const std::size_t threads : {1U, 3U}) {
        std::vector<Vec3> listed(gas.positions.size(), Vec3::Zero());
        const EnergyTerms of_list =
            add_forces(gas.topology, settings, list, gas.positions, listed, threads);
        CHECK(of_list.solvation == Approx(energy.solvation).epsilon(1e-12));
        CHECK(of_list.total() == Approx(energy.total()).epsilon(1e-11));
        for (std::size_t i = 0; i < listed.size(); ++i)
            CHECK((listed[i] - forces[i]).norm() <= 1e-11 * (1 + forces[i].norm()));
    }
}

TEST_CASE("forces with solvation are the derivative of the energy", "[forces][solvation]") {
    const SolvatedGas gas = build_solvated_gas(24, 5, 8);
    const NonbondedSettings settings = eef1_settings();
    const auto add = [&](std::span<const Vec3> x, std::span<Vec3> f) {
        return add_nonbonded_forces(gas.topology, settings, x, f).sum() +
               add_nonbonded14_forces(gas.topology, settings, x, f).sum();
    };
    test::check_forces(add, gas.positions);

    // To an error of h^4.
    constexpr double h = 1e-3;
    std::vector<Vec3> forces, ignored;
    test::forces_of(add, gas.positions, forces);
    double largest = 0;
    for (const Vec3& force : forces) largest = std::max(largest, force.norm());
    for (std::size_t i = 0; i < forces.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = [&](double by) {
                std::vector<Vec3> moved = gas.positions;
                moved[i](axis) += by;
                return test::forces_of(add, moved, ignored);
            };
            const double slope =
                (45 * (at(h) - at(-h)) - 9 * (at(2 * h) - at(-2 * h)) + at(3 * h) - at(-3 * h)) /
                (60 * h);
            CHECK(std::abs(forces[i](axis) + slope) <= 1e-8 * largest);
        }
    }
}

TEST_CASE("smooth ends leave no step in energy, force or stiffness", "[forces][solvation]") {
    const SolvatedPair pair("NH3", "CT3");
    const auto check_edge = [&](double edge, const NonbondedSettings& settings) {
        INFO("at " << edge << " Å");
        constexpr double h = 1e-5;
        const auto stiffness = [&](double r) {
            return (pair.at(r + h, settings)[1] - pair.at(r - h, settings)[1]) / (2 * h);
        };
        for (const std::size_t what : {0U, 1U}) {
            CHECK(pair.at(edge - 1e-9, settings)[what] ==
                  Approx(pair.at(edge + 1e-9, settings)[what]).margin(1e-9).epsilon(0));
        }
        // Its slope is below 1 kcal/mol/Å^3 here.
        CHECK(stiffness(edge - 2e-5) == Approx(stiffness(edge + 2e-5)).margin(1e-4).epsilon(0));
    };
    NonbondedSettings alone = eef1_settings();
    alone.coulomb_constant = 0;
    for (const double edge : {7.0, 8.5, 9.0, 9.5}) {
        check_edge(edge, eef1_settings());
        check_edge(edge, alone);
    }
    CHECK(pair.at(9.5, eef1_settings())[0] == 0);
    CHECK(pair.at(9.5, eef1_settings())[1] == 0);
    CHECK(pair.at(9.499, eef1_settings())[0] != 0);
    // Where the sharp one lets go of something.
    const NonbondedSettings sharp = eef1_settings(SolvationEnd::Sharp);
    CHECK(std::abs(pair.at(9 - 1e-9, sharp)[0] - pair.at(9 + 1e-9, sharp)[0]) > 1e-3);
    CHECK(pair.at(9 + 1e-9, sharp)[0] == 0);
}

TEST_CASE("the electrostatic end is a polynomial in the square of the distance",
          "[forces][solvation]") {
    SolvatedPair pair("CT3", "CT3");
    pair.topology.lennard_jones = {1, {{0, 1}}};
    const NonbondedSettings settings = eef1_settings(SolvationEnd::None);
    const double K = 332.0716 * 0.6 * -0.4 / 1.5, c2 = 81;
    for (const double r : {0.5, 2.0, 4.7, 8.9}) {
        const double s = r * r;
        CHECK(pair.at(r, settings)[0] ==
              Approx(K * (1 / s - 3 / c2 + 3 * s / (c2 * c2) - s * s / (c2 * c2 * c2)))
                  .epsilon(1e-11)
                  .margin(1e-14));
        CHECK(pair.at(r, settings)[1] ==
              Approx(-K * (-2 / (s * r) + 6 * r / (c2 * c2) - 4 * s * r / (c2 * c2 * c2)))
                  .epsilon(1e-11)
                  .margin(1e-14));
    }
}

TEST_CASE("solvated atoms on top of each other are finite and do not push", "[forces][solvation]") {
    const SolvatedPair pair("OC", "CA");
    for (const SolvationEnd end : {SolvationEnd::Sharp, SolvationEnd::Smooth}) {
        const NonbondedSettings settings = eef1_settings(end);
        for (const double r :
             {0.0, std::numeric_limits<double>::denorm_min(), 1e-12, 1e-3, 0.05, 0.1, 1.0}) {
            CHECK(std::isfinite(pair.at(r, settings)[0]));
            CHECK(std::isfinite(pair.at(r, settings)[1]));
        }
        CHECK(pair.at(0, settings)[1] == 0);
        const SolvationLaw law(end);
        const SolvationAtom a = solvation_atom(*pair.topology.solvation, 0);
        const SolvationAtom b = solvation_atom(*pair.topology.solvation, 1);
        const auto energy = [&](double r) {
            const SolvationPair of = law.evaluate(r * r, a, b);
            return of.energy_a + of.energy_b;
        };
        constexpr double core = pair_core_radius, h = 1e-6;
        CHECK(energy(core - 1e-12) == Approx(energy(core + 1e-12)).epsilon(1e-9));
        CHECK(0.04 * law.evaluate(0.04 * 0.04, a, b).first ==
              Approx((energy(0.04 + h) - energy(0.04 - h)) / (2 * h)).epsilon(1e-6));
    }
    // Whatever the places: a thousand of them, some atoms on top of each other.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-3, 3);
    SolvatedGas gas = build_solvated_gas(30, 6, 4);
    for (int k = 0; k < 1000; ++k) {
        for (Vec3& place : gas.positions) {
            const double x = uniform(random), y = uniform(random), z = uniform(random);
            place = Vec3(std::round(x), std::round(y), k % 2 == 0 ? z : std::round(z));
        }
        std::vector<Vec3> forces(gas.positions.size(), Vec3::Zero());
        const EnergyTerms energy = add_forces(gas.topology, eef1_settings(), gas.positions, forces);
        CHECK(std::isfinite(energy.total()));
        CHECK(std::ranges::all_of(forces, [](const Vec3& f) { return f.allFinite(); }));
    }
}

TEST_CASE("an atom without volume and energy takes nothing and loses nothing",
          "[forces][solvation]") {
    const SolvatedPair hydrogen("NH3", "H"), carbonyl("NH3", "C"), carbonyls("C", "C");
    for (const SolvatedPair* pair : {&hydrogen, &carbonyls}) {
        CHECK(pair->at(3, eef1_settings()) == pair->at(3, eef1_settings(SolvationEnd::None)));
    }
    // It has a volume.
    CHECK(carbonyl.at(3, eef1_settings()) != carbonyl.at(3, eef1_settings(SolvationEnd::None)));
}

TEST_CASE("fields between groups have the law of the force field", "[forces][solvation]") {
    // Two groups whose inner pairs are excluded by bonds from one atom to its group.
    SolvatedGas gas = build_solvated_gas(40, 6, 12);
    std::vector<Bond> bonds;
    for (std::uint32_t i = 1; i < 15; ++i) bonds.push_back({0, i, 0, 0});
    for (std::uint32_t i = 16; i < 40; ++i) bonds.push_back({15, i, 0, 0});
    gas.topology.exclusions = build_exclusions(bonds, 40);
    const FastAtoms atoms = build_fast_atoms(gas.topology);
    std::vector<double> volume, strength, inverse_lambda, radius;
    for (std::size_t i = 0; i < 40; ++i) {
        const SolvationAtom atom = solvation_atom(*gas.topology.solvation, i);
        volume.push_back(atom.volume);
        strength.push_back(atom.strength);
        inverse_lambda.push_back(atom.inverse_lambda);
        radius.push_back(atom.radius);
    }
    const auto points = [&](std::size_t first, std::size_t count) {
        const auto part = [&](const auto& all) { return std::span(all).subspan(first, count); };
        return FieldPoints{part(gas.positions),
                           part(gas.topology.charge),
                           part(atoms.sqrt_epsilon),
                           part(atoms.half_rmin),
                           {},
                           {part(volume), part(strength), part(inverse_lambda), part(radius)}};
    };
    for (const SolvationEnd end : {SolvationEnd::Smooth, SolvationEnd::Sharp, SolvationEnd::None}) {
        const NonbondedSettings settings = eef1_settings(end);
        std::vector<Vec3> forces(40, Vec3::Zero()), expected(40, Vec3::Zero());
        const NonbondedEnergy energy =
            add_nonbonded_forces(gas.topology, settings, gas.positions, forces);
        const auto rule = find_field_rule(settings);
        REQUIRE(rule);
        const FieldSum field =
            add_pair_forces(points(0, 15), points(15, 25), *rule, std::span(expected).first(15),
                            std::span(expected).last(25));
        CHECK(energy.van_der_waals == Approx(field.van_der_waals).epsilon(1e-12));
        CHECK(energy.electrostatic == Approx(field.electrostatic).epsilon(1e-12));
        CHECK(energy.solvation == Approx(field.solvation).epsilon(1e-12));
        for (std::size_t i = 0; i < 40; ++i)
            CHECK((forces[i] - expected[i]).norm() < 1e-11 * (1 + expected[i].norm()));
    }
    CHECK(find_field_rule({}));
    CHECK_FALSE(find_field_rule({})->smooth);
    CHECK_FALSE(find_field_rule({.electrostatics = ElectrostaticCutoff::Shift}));
}
