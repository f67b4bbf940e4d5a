// What changes when groups move as rigid bodies is held against the whole force field, which knows
// no groups: the rest of it turns with each group and keeps its energy.
#include "forces/group_forces.h"

#include "tests/support/paths.h"
#include "tests/support/reference_case.h"
#include "tests/support/solvation_of.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr std::size_t group_count = 4;

struct GroupedPeptide {
    test::ReferenceCase reference =
        test::read_reference_case(test::test_data("tetra_aera_c36m.ff.json"));
    std::vector<Vec3> positions =
        test::read_reference_frames(test::test_data("tetra_aera_c36m.frames.json"))
            .front()
            .positions;
    Topology& topology = reference.topology;

    GroupedPeptide() {
        std::vector<std::string> types;
        for (const test::ReferenceAtom& atom : reference.atoms) types.push_back(atom.type);
        topology.solvation = test::solvation_of(types);
    }
};

// Residue by residue, the atoms of the last in a group of the first.
std::vector<std::uint32_t> groups_of(const GroupedPeptide& peptide) {
    std::vector<std::uint32_t> groups;
    for (const test::ReferenceAtom& atom : peptide.reference.atoms)
        groups.push_back(static_cast<std::uint32_t>(atom.number) % group_count);
    return groups;
}

struct GroupMove {
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();
};

// One for each group, by a few tenths of Å at the peptide's ends.
std::vector<GroupMove> random_group_moves() {
    std::mt19937 random(41);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto draw = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    std::vector<GroupMove> moves;
    for (std::size_t group = 0; group < group_count; ++group) {
        const Vec3 axis = draw().normalized();
        moves.push_back({Eigen::AngleAxisd(0.02, axis).toRotationMatrix(), 0.05 * draw()});
    }
    return moves;
}

struct GroupSum {
    EnergyTerms energy;
    std::vector<Vec3> forces;
};

GroupSum sum_whole(const Topology& topology, const NonbondedSettings& settings,
                   const std::vector<Vec3>& positions) {
    GroupSum sum{{}, std::vector<Vec3>(positions.size(), Vec3::Zero())};
    sum.energy = add_forces(topology, settings, positions, sum.forces);
    return sum;
}

GroupSum sum_across(const Topology& topology, const NonbondedSettings& settings,
                    GroupForces& group_forces, const std::vector<Vec3>& positions) {
    GroupSum sum{{}, std::vector<Vec3>(positions.size(), Vec3::Zero())};
    sum.energy = add_group_forces(topology, settings, group_forces, positions, sum.forces);
    return sum;
}

// Moved by its group's move, what stays of the whole is as it was: energy, and forces seen from the
// group.
void check_rest_is_rigid(const GroupedPeptide& peptide, const NonbondedSettings& settings,
                         GroupForces& group_forces, double energy_margin, double force_margin) {
    const std::vector<std::uint32_t> groups = groups_of(peptide);
    const std::vector<GroupMove> moves = random_group_moves();
    std::vector<Vec3> moved;
    for (std::size_t i = 0; i < groups.size(); ++i)
        moved.emplace_back(moves[groups[i]].turn * peptide.positions[i] + moves[groups[i]].shift);

    const GroupSum all = sum_whole(peptide.topology, settings, peptide.positions);
    const GroupSum all_moved = sum_whole(peptide.topology, settings, moved);
    const GroupSum part = sum_across(peptide.topology, settings, group_forces, peptide.positions);
    const GroupSum part_moved = sum_across(peptide.topology, settings, group_forces, moved);

    REQUIRE(std::abs(all_moved.energy.total() - all.energy.total()) > 1);
    CHECK(part_moved.energy.total() - part.energy.total() ==
          Approx(all_moved.energy.total() - all.energy.total()).margin(energy_margin).epsilon(0));
    for (std::size_t i = 0; i < groups.size(); ++i) {
        INFO("atom " << i);
        const Vec3 rest = all.forces[i] - part.forces[i];
        const Vec3 rest_moved = all_moved.forces[i] - part_moved.forces[i];
        CHECK((moves[groups[i]].turn.transpose() * rest_moved - rest).norm() < force_margin);
    }
}

const NonbondedSettings group_settings{.electrostatics = ElectrostaticCutoff::ForceShift,
                                       .van_der_waals = VanDerWaalsCutoff::ForceSwitch,
                                       .switch_from = 7,
                                       .cutoff = 9};
const NonbondedSettings switched_settings{.electrostatics = ElectrostaticCutoff::ForceSwitch,
                                          .van_der_waals = VanDerWaalsCutoff::ForceSwitch,
                                          .switch_from = 7,
                                          .cutoff = 9};

}  // namespace

TEST_CASE("all that changes when groups move rigidly is in the sum across groups",
          "[forces][groups]") {
    const GroupedPeptide peptide;
    const std::vector<std::uint32_t> groups = groups_of(peptide);

    SECTION("all pairs, in double") {
        const NonbondedSettings settings =
            GENERATE(NonbondedSettings{}, NonbondedSettings{.dielectric = 2.5}, eef1_settings());
        GroupForces group_forces = build_group_forces(peptide.topology, nullptr, groups);
        check_rest_is_rigid(peptide, settings, group_forces, 1e-9, 1e-9);
    }
    SECTION("pairs of a list, in double") {
        const NonbondedSettings settings = GENERATE(eef1_settings(), group_settings);
        const PairList list = build_pair_list(peptide.topology.exclusions, find_reach(settings), 2,
                                              peptide.positions);
        GroupForces group_forces = build_group_forces(peptide.topology, &list, groups);
        check_rest_is_rigid(peptide, settings, group_forces, 1e-9, 1e-9);
    }
    SECTION("by the kernel, in single precision") {
        const FastForceField fast = build_fast_force_field(peptide.topology);
        const NonbondedSettings settings =
            GENERATE(NonbondedSettings{}, switched_settings, eef1_settings());
        FastPairs pairs;
        std::vector<Vec3> forces(peptide.positions.size(), Vec3::Zero());
        (void)add_fast_forces(peptide.topology, fast, settings, 2, peptide.positions, pairs, forces,
                              PairResult::ForcesAndEnergies);
        GroupForces group_forces = build_fast_group_forces(peptide.topology, fast.atoms, pairs,
                                                           groups, peptide.positions, 2);
        // 2e-5 of forces of some 50 kcal/mol/Å, as the kernel has them.
        check_rest_is_rigid(peptide, settings, group_forces, 1e-3, 1e-3);
        CHECK_FALSE(group_forces.was_in_double);
    }
}

TEST_CASE("atoms that nothing across groups reaches are neither read nor written",
          "[forces][groups]") {
    const GroupedPeptide peptide;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    // One group but for the first atom: at 4 Å only its surroundings act on it.
    std::vector<std::uint32_t> groups(peptide.positions.size(), 0);
    groups[0] = 1;
    const PairList list = build_pair_list(peptide.topology.exclusions, 4, 0, peptide.positions);
    GroupForces group_forces = build_group_forces(peptide.topology, &list, groups);
    std::vector<bool> is_used(groups.size(), false);
    for (const std::uint32_t atom : group_forces.atoms) is_used[atom] = true;
    std::vector<Vec3> positions = peptide.positions;
    std::size_t unused = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (is_used[i]) continue;
        ++unused;
        positions[i].setConstant(nan);
        CHECK((peptide.positions[i] - peptide.positions[0]).norm() >= 4);
    }
    REQUIRE(unused > 0);

    const NonbondedSettings settings{
        .van_der_waals = VanDerWaalsCutoff::Switch, .switch_from = 3, .cutoff = 4};
    const GroupSum sum = sum_across(peptide.topology, settings, group_forces, positions);

    CHECK(std::isfinite(sum.energy.total()));
    for (std::size_t i = 0; i < positions.size(); ++i) {
        CHECK(sum.forces[i].allFinite());
        if (!is_used[i]) CHECK(sum.forces[i].norm() == 0);
    }
}

TEST_CASE("one group has nothing across, and with a group for each atom that is everything",
          "[forces][groups]") {
    const GroupedPeptide peptide;
    const std::size_t count = peptide.positions.size();

    GroupForces none =
        build_group_forces(peptide.topology, nullptr, std::vector<std::uint32_t>(count, 7));
    CHECK(none.atoms.empty());
    CHECK(sum_across(peptide.topology, {}, none, peptide.positions).energy.magnitude() == 0);

    std::vector<std::uint32_t> own(count);
    for (std::uint32_t i = 0; i < count; ++i) own[i] = i;
    GroupForces everything = build_group_forces(peptide.topology, nullptr, own);
    const GroupSum sum = sum_across(peptide.topology, {}, everything, peptide.positions);
    const GroupSum all = sum_whole(peptide.topology, {}, peptide.positions);
    CHECK(everything.atoms.size() == count);
    CHECK(sum.energy.total() == Approx(all.energy.total()).margin(1e-9));
    CHECK(sum.energy.lj14 == Approx(all.energy.lj14).margin(1e-9));
    for (std::size_t i = 0; i < count; ++i) CHECK((sum.forces[i] - all.forces[i]).norm() < 1e-9);
}
