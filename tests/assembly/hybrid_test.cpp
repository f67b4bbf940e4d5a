#include "assembly/hybrid.h"

#include "assembly/metric.h"
#include "tests/support/torsion_held.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

using namespace palpa;
using test::Held;
using test::TorsionCase;
using test::TorsionShape;

namespace {

struct Hybrid {
    AssemblyTree whole;
    AssemblyState whole_state;
    HybridTree tree;
    HybridState state;
};

Hybrid hybrid_of(const TorsionCase& c, const Held& held) {
    Hybrid h;
    h.whole = build_assembly_tree(c.bodies, c.masses, c.positions);
    h.whole_state = build_assembly_state(h.whole);
    h.whole_state.is_active = held.is_active;
    h.whole_state.guides = held.guides;
    h.tree = build_hybrid_tree(h.whole, held.is_active, c.positions);
    h.state = build_hybrid_state(h.tree, held.is_active, held.guides);
    return h;
}

// As a full pass lays them out.
test::TorsionAccelerations accelerations_of(const Hybrid& h) {
    test::TorsionAccelerations result{std::vector<double>(h.whole.bodies.bodies.size(), 0),
                                      h.state.passes.base_acceleration};
    for (std::size_t c = 0; c < h.tree.body_of.size(); ++c) {
        result.joints[h.tree.body_of[c]] = h.state.passes.joint_acceleration[c];
    }
    return result;
}

// Of the hybrid against an oracle or the full pass.
double worst_of(const TorsionCase& c, Hybrid& h, const test::TorsionAccelerations& expected) {
    update_wrenches(h.tree, c.positions, c.forces, h.state);
    update_accelerations(h.tree, h.state);
    const auto [joints, bases] = accelerations_of(h);
    AssemblyState state;
    state.joint_acceleration = joints;
    state.base_acceleration = bases;
    return test::worst_difference(state, expected);
}

test::TorsionAccelerations full_pass(const TorsionCase& c, Hybrid& h) {
    update_accelerations(h.whole, c.positions, c.forces, h.whole_state);
    return {h.whole_state.joint_acceleration, h.whole_state.base_acceleration};
}

// Angle about the joint's bond between an atom on the parent's and one on the child's side.
double torsion_of(const std::vector<Vec3>& positions, const std::array<std::uint32_t, 4>& atoms) {
    const auto [i, j, k, l] = atoms;
    const Vec3 axis = (positions[k] - positions[j]).normalized();
    const auto across = [&](std::uint32_t atom) {
        const Vec3 arm = positions[atom] - positions[j];
        return Vec3(arm - axis.dot(arm) * axis);
    };
    const Vec3 from = across(i), to = across(l);
    return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

}  // namespace

TEST_CASE("a few joints of a tree accelerate as if the others were rigid", "[assembly][hybrid]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (std::uint32_t seed = 0; seed < 25; ++seed) {
        const std::size_t bodies = 1 + 2 * seed;
        const TorsionCase c = test::torsion_case(seed, bodies, shape);
        for (const double share : {0.0, 0.2, 0.8, 1.0}) {
            INFO(bodies << " bodies, seed " << seed << ", rigid " << share);
            const Held held = test::some_held(c, seed, share);
            Hybrid h = hybrid_of(c, held);

            CHECK(worst_of(c, h, test::dense_accelerations(c, held)) <= 1e-9);
            CHECK(worst_of(c, h, full_pass(c, h)) <= 1e-9);
        }
    }
}

TEST_CASE("clusters of several molecules do not touch each other", "[assembly][hybrid]") {
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        test::TorsionCaseBuilder builder(seed);
        for (const std::size_t bodies : {4, 1, 12, 2}) builder.add_molecule(bodies);
        const TorsionCase c = builder.take();
        const Held held = test::some_held(c, seed, 0.5);
        Hybrid h = hybrid_of(c, held);

        CHECK(worst_of(c, h, test::dense_accelerations(c, held)) <= 1e-9);
    }
}

TEST_CASE("few joints of large trees accelerate as the recursion in long double says",
          "[assembly][hybrid][slow]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (const std::size_t bodies : {200, 2000, 20001}) {
        const TorsionCase c = test::torsion_case(1, bodies, shape);
        for (const double share : {0.0, 0.5, 0.98}) {
            INFO(bodies << " bodies, rigid " << share);
            const Held held = test::some_held(c, 2, share);
            Hybrid h = hybrid_of(c, held);
            CHECK(worst_of(c, h, test::recursive_accelerations(c, held)) <= 1e-6);
        }
    }
}

TEST_CASE("every atom is in one cluster, with all that is rigid towards it", "[assembly][hybrid]") {
    const TorsionCase c = test::torsion_case(4, 60, TorsionShape::Tree);
    const Held held = test::some_held(c, 5, 0.6);
    const Hybrid h = hybrid_of(c, held);

    std::vector<std::uint32_t> atoms = h.tree.tree.atoms;
    std::ranges::sort(atoms);
    for (std::uint32_t i = 0; i < c.masses.size(); ++i) REQUIRE(atoms[i] == i);
    for (std::uint32_t b = 1; b < 60; ++b) {
        const bool is_joined = h.tree.cluster_of[b] == h.tree.cluster_of[c.bodies.bodies[b].parent];
        CHECK(is_joined == (held.is_active[b] == 0));
    }
    for (std::uint32_t k = 0; k < h.tree.clusters.size(); ++k) {
        for (std::uint32_t i = h.tree.tree.first_atom[k]; i < h.tree.tree.first_atom[k + 1]; ++i) {
            CHECK(h.tree.cluster_of[c.bodies.body_of[h.tree.tree.atoms[i]]] == k);
        }
    }
}

TEST_CASE("clusters move as rigid bodies and accelerate as new ones would", "[assembly][hybrid]") {
    const auto shape = GENERATE(TorsionShape::Tree, TorsionShape::Comb, TorsionShape::Star);
    TorsionCase c = test::torsion_case(11, 40, shape);
    Held held = test::some_held(c, 11, 0.5);
    held.guides[0].guide = BaseGuide::Point;
    held.guides[0].point = c.positions[0];  // of the base
    held.is_active[0] = 1;
    Hybrid h = hybrid_of(c, held);
    const std::vector<Vec3> first = c.positions;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-0.1, 0.1);
    const std::size_t clusters = h.tree.clusters.size();
    std::vector<double> turned(clusters, 0);
    for (int step = 0; step < 200; ++step) {
        std::vector<double> turns;
        for (std::size_t k = 0; k < clusters; ++k) turns.push_back(uniform(random));
        Vec6 move;
        for (int i = 0; i < 6; ++i) move[i] = uniform(random);
        const std::vector<Vec3> before = c.positions;
        const Vec3 centre = test::centres_of(c)[0];
        move_clusters(h.tree, turns, std::vector<Vec6>{move}, h.state);
        update_positions(h.tree, h.state, c.positions);
        update_clusters(h.tree, h.state);
        for (std::size_t k = 0; k < clusters; ++k) turned[k] += turns[k];

        // The base turns about the molecule's centre of mass.
        const Eigen::AngleAxisd turn(move.head<3>().norm(), move.head<3>().normalized());
        const Vec3 expected = centre + turn * (before[0] - centre) + move.tail<3>();
        REQUIRE((c.positions[0] - expected).norm() < 1e-9);
        for (std::size_t i = 0; i < before.size(); ++i) {
            const RigidMotion& motion = h.state.motions[h.tree.cluster_of[c.bodies.body_of[i]]];
            REQUIRE((motion * before[i] - c.positions[i]).norm() < 1e-9);
        }
    }

    // No joint but those that are active has turned, and these as far as they were told to.
    for (std::uint32_t b = 1; b < 40; ++b) {
        const auto& [parent, axis] = c.bodies.bodies[b];
        const auto other_of = [&](std::uint32_t body) {
            for (std::uint32_t i = 0; i < c.masses.size(); ++i) {
                if (c.bodies.body_of[i] == body && i != axis[0] && i != axis[1]) return i;
            }
            return axis[0];
        };
        const std::array atoms{other_of(parent), axis[0], axis[1], other_of(b)};
        if (atoms[0] == axis[0] || atoms[3] == axis[0]) continue;
        const double change = torsion_of(c.positions, atoms) - torsion_of(first, atoms);
        const double expected = held.is_active[b] != 0 ? turned[h.tree.cluster_of[b]] : 0;
        INFO("joint " << b);
        CHECK(std::remainder(change - expected, 2 * std::numbers::pi) == Approx(0).margin(1e-8));
    }
    for (std::size_t i = 0; i < c.masses.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (h.tree.cluster_of[c.bodies.body_of[i]] != h.tree.cluster_of[c.bodies.body_of[j]])
                continue;
            const double distance = (c.positions[i] - c.positions[j]).norm();
            CHECK(distance == Approx((first[i] - first[j]).norm()).margin(1e-10));
        }
    }
    // The guide's point went along.
    REQUIRE(h.state.passes.guides[0].point);
    CHECK((*h.state.passes.guides[0].point - c.positions[0]).norm() < 1e-9);
    held.guides = h.whole_state.guides = h.state.passes.guides;
    CHECK(worst_of(c, h, test::dense_accelerations(c, held)) <= 1e-9);
    CHECK(worst_of(c, h, full_pass(c, h)) <= 1e-9);
}

TEST_CASE("clusters have the metric of the joints that are active", "[assembly][hybrid]") {
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
        const TorsionCase c = test::torsion_case(seed, 80, TorsionShape::Tree);
        Held held = test::some_held(c, seed, 0.7);
        held.is_active[0] = 1;
        held.guides[0].guide = seed % 2 == 0 ? BaseGuide::None : BaseGuide::Point;
        Hybrid h = hybrid_of(c, held);
        full_pass(c, h);
        update_wrenches(h.tree, c.positions, c.forces, h.state);
        update_accelerations(h.tree, h.state);
        AccelerationMetric whole = build_acceleration_metric(h.whole);
        AccelerationMetric metric = build_acceleration_metric(h.tree.tree);
        update_metric(h.whole, h.whole_state, {}, whole);
        update_metric(h.tree.tree, h.state.passes, {}, metric);

        const double expected = find_metric(h.whole, h.whole_state, whole, h.whole.roots[0]);
        CHECK(expected > 0);
        CHECK(find_metric(h.tree.tree, h.state.passes, metric, h.tree.tree.roots[0]) ==
              Approx(expected).epsilon(1e-9));
        CHECK(whole.bases[0] > 0);
        CHECK(metric.bases[0] == Approx(whole.bases[0]).epsilon(1e-9));
    }
}
