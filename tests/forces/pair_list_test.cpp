#include "forces/pair_list.h"

#include "forces/force_field.h"
#include "tests/support/check_forces.h"
#include "tests/support/paths.h"
#include "tests/support/reference_case.h"
#include "tests/support/shared_data.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace palpa;

namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

// Lower index first, rising.
Pairs pairs_of(const PairList& list) {
    Pairs pairs;
    for (std::size_t row = 0; row < list.atoms.size(); ++row) {
        for (const std::uint32_t j : list.neighbours_of(row))
            pairs.push_back({std::min(list.atoms[row], j), std::max(list.atoms[row], j)});
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

Pairs all_near(const Exclusions& exclusions, double reach, const std::vector<Vec3>& positions) {
    Pairs pairs;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const auto excluded = exclusions.of(i);
        for (std::uint32_t j = i + 1; j < positions.size(); ++j) {
            if (std::find(excluded.begin(), excluded.end(), j) == excluded.end() &&
                (positions[i] - positions[j]).norm() < reach)
                pairs.push_back({i, j});
        }
    }
    return pairs;
}

// Chains of ten through random places.
Exclusions chains(std::uint32_t atoms) {
    std::vector<Bond> bonds;
    for (std::uint32_t i = 1; i < atoms; ++i) {
        if (i % 10 != 0) bonds.push_back({i - 1, i, 0, 0});
    }
    return build_exclusions(bonds, atoms);
}

}  // namespace

TEST_CASE("a list has every near pair once, wherever the atoms are", "[forces][pairs]") {
    struct Place {
        const char* name;
        Vec3 spread, middle;
    };
    const Place place = GENERATE(
        Place{"a box", {15, 15, 15}, {0, 0, 0}}, Place{"far away", {15, 15, 15}, {1e5, -1e5, 9e4}},
        Place{"a plate", {60, 60, 0}, {3, 4, 5}}, Place{"a line", {0, 0, 500}, {0, 0, 0}},
        Place{"one place", {0, 0, 0}, {1, 1, 1}}, Place{"almost empty", {1e5, 1e5, 1e5}, {0, 0, 0}},
        Place{"beyond all cells", {20, 20, 20}, {1e9, -1e9, 0}});
    INFO(place.name);
    std::mt19937 random(23);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Vec3> positions;
    for (int i = 0; i < 600; ++i) {
        const Vec3 direction(uniform(random), uniform(random), uniform(random));
        positions.emplace_back(place.middle + place.spread.cwiseProduct(direction));
    }
    const Exclusions exclusions = chains(600);

    const PairList list = build_pair_list(exclusions, 5, 1, positions);

    CHECK(pairs_of(list) == all_near(exclusions, 6, positions));
}

TEST_CASE("a list has pairs that are only just within reach, across three cells",
          "[forces][pairs]") {
    // Cells a little narrower than half the reach would put the last two atoms three cells apart.
    const double half = 3 * (1 - 1e-9);
    const std::vector<Vec3> positions{{0, 0, 0}, {half - 1e-12, 0, 0}, {3 * half, 0, 0}};
    const Exclusions exclusions = build_exclusions({}, 3);

    CHECK(pairs_of(build_pair_list(exclusions, 5, 1, positions)) == Pairs{{0, 1}, {1, 2}});
}

TEST_CASE("a list repeats, also in the memory of another", "[forces][pairs]") {
    std::mt19937 random(29);
    const std::vector<Vec3> positions = test::random_positions(random, 300, 12, 0.5);
    const std::vector<Vec3> others = test::random_positions(random, 500, 12, 0.3);
    const Exclusions exclusions = chains(300);

    const PairList first = build_pair_list(exclusions, 5, 1, positions);
    const PairList second = build_pair_list(exclusions, 5, 1, positions, {},
                                            build_pair_list(chains(500), 7, 2, others));

    CHECK(first.atoms == second.atoms);
    CHECK(first.first == second.first);
    CHECK(first.neighbours == second.neighbours);
}

TEST_CASE("a list leaves out pairs of two fixed atoms", "[forces][pairs]") {
    std::mt19937 random(31);
    const std::vector<Vec3> positions = test::random_positions(random, 300, 10, 0.5);
    std::vector<std::uint8_t> is_fixed(300, 0);
    for (std::size_t i = 0; i < 300; i += 3) is_fixed[i] = 1;
    const Exclusions exclusions = chains(300);
    Pairs expected = all_near(exclusions, 6, positions);
    std::erase_if(expected,
                  [&](const auto& pair) { return is_fixed[pair[0]] && is_fixed[pair[1]]; });

    CHECK(pairs_of(build_pair_list(exclusions, 5, 1, positions, is_fixed)) == expected);
}

TEST_CASE("an atom that is nowhere has no neighbours", "[forces][pairs]") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::vector<Vec3> positions{
        {0, 0, 0}, {nan, 0, 0}, {1, 0, 0}, {0, -infinity, infinity}, {nan, nan, nan}};

    const PairList list = build_pair_list(build_exclusions({}, 5), 5, 1, positions);

    CHECK(pairs_of(list) == Pairs{{0, 2}});
    CHECK(pairs_of(build_pair_list(build_exclusions({}, 0), 5, 1, {})).empty());
}

TEST_CASE("a list is outdated once an atom has moved more than half the skin", "[forces][pairs]") {
    std::vector<Vec3> positions{{0, 0, 0}, {3, 0, 0}};
    const PairList list = build_pair_list(build_exclusions({}, 2), 5, 1, positions);

    CHECK_FALSE(is_outdated(list, positions));
    positions[1].y() = 0.5;
    CHECK_FALSE(is_outdated(list, positions));
    positions[1].y() = -0.5000001;
    CHECK(is_outdated(list, positions));
}

TEST_CASE("shares of a list are all of its rows, each once", "[forces][pairs]") {
    std::mt19937 random(37);
    const PairList list =
        build_pair_list(chains(200), 5, 1, test::random_positions(random, 200, 8, 0.5));
    std::size_t next = 0;

    for (int i = 0; i < 5; ++i) {
        const PairRows rows = find_rows(list, 0.2 * i, i == 4 ? 1 : 0.2 * (i + 1));
        CHECK(rows.begin == next);
        next = rows.end;
        const double pairs =
            static_cast<double>(list.first[rows.end]) - static_cast<double>(list.first[rows.begin]);
        CHECK(pairs == Approx(0.2 * static_cast<double>(list.neighbours.size())).margin(200));
    }
    CHECK(next == list.atoms.size());
}

namespace {

// The list against all pairs with the same cutoff: energies relative to the largest term, as terms
// of both signs add up, forces to the larger of their own and the rms force.
void check_against_all_pairs(const test::ReferenceCase& reference,
                             const std::vector<Vec3>& positions, const NonbondedSettings& settings,
                             double moved, std::size_t threads) {
    const std::size_t n = positions.size();
    const PairList list =
        build_pair_list(reference.topology.exclusions, settings.cutoff, 2 * moved, positions);
    std::mt19937 random(41);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Vec3> places = positions;
    for (Vec3& place : places) {
        place += moved / std::sqrt(3) * Vec3(uniform(random), uniform(random), uniform(random));
    }
    REQUIRE_FALSE(is_outdated(list, places));
    std::vector<Vec3> forces(n, Vec3::Zero()), expected(n, Vec3::Zero());

    const EnergyTerms energy =
        add_forces(reference.topology, settings, list, places, forces, threads);
    const EnergyTerms all = add_forces(reference.topology, settings, places, expected);

    CHECK(energy.bond == all.bond);
    CHECK(energy.lj == Approx(all.lj).epsilon(1e-12));
    CHECK(energy.coulomb == Approx(all.coulomb).epsilon(1e-12));
    double rms = 0;
    for (const Vec3& force : expected) rms += force.squaredNorm() / static_cast<double>(n);
    rms = std::sqrt(rms);
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
        worst =
            std::max(worst, (forces[i] - expected[i]).norm() / std::max(rms, expected[i].norm()));
    }
    CHECK(worst < 1e-10);

    std::vector<Vec3> again(n, Vec3::Zero());
    CHECK(add_forces(reference.topology, settings, list, places, again, threads).total() ==
          energy.total());
    CHECK(again == forces);
}

NonbondedSettings ended(ElectrostaticCutoff electrostatics, VanDerWaalsCutoff van_der_waals,
                        bool distance, double cutoff) {
    return {.distance_dielectric = distance,
            .electrostatics = electrostatics,
            .van_der_waals = van_der_waals,
            .switch_from = 0.75 * cutoff,
            .cutoff = cutoff};
}

}  // namespace

TEST_CASE("a list gives what all pairs with the cutoff give, by every function",
          "[forces][pairs]") {
    using enum ElectrostaticCutoff;
    const auto electrostatics = GENERATE(Switch, Shift, ForceShift, ForceSwitch);
    const auto van_der_waals = GENERATE(VanDerWaalsCutoff::Switch, VanDerWaalsCutoff::ForceSwitch);
    const bool distance = GENERATE(false, true);
    const NonbondedSettings settings = ended(electrostatics, van_der_waals, distance, 6);
    if (find_problem(settings)) return;
    const test::ReferenceCase reference =
        test::read_reference_case(test::test_data("tetra_aera_c36m.ff.json"));
    const std::vector<Vec3> positions =
        test::read_reference_frames(test::test_data("tetra_aera_c36m.frames.json"))
            .front()
            .positions;

    check_against_all_pairs(reference, positions, settings, 0.5, 1);
    // Some pairs inside of the core, all at one place.
    check_against_all_pairs(reference, std::vector<Vec3>(positions.size(), Vec3::Zero()), settings,
                            0.06, 1);
}

TEST_CASE("a list gives what all pairs of a protein give, on any number of threads",
          "[forces][pairs][reference]") {
    const auto folder = test::find_shared_data("reference");
    if (!folder) return;
    const test::ReferenceCase reference =
        test::read_reference_case(*folder / "hiv_tl3_c36m.ff.json");
    const std::vector<Vec3> positions =
        test::read_reference_frames(*folder / "hiv_tl3_c36m.minimised_300_steps.json")
            .front()
            .positions;

    for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
        INFO(threads << " threads");
        check_against_all_pairs(
            reference, positions,
            ended(ElectrostaticCutoff::ForceShift, VanDerWaalsCutoff::Switch, false, 9), 0.02,
            threads);
    }
}
