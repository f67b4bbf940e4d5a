#include "assembly/passes.h"

#include "tests/support/shared_data.h"
#include "tests/support/torsion_held.h"
#include "tests/support/torsion_reference.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
using test::Held;
using test::TorsionAccelerations;
using test::TorsionCase;
using test::TorsionShape;

namespace {

AssemblyState state_of(const TorsionCase& c, const AssemblyTree& tree, const Held& held) {
    AssemblyState state = build_assembly_state(tree);
    state.is_active = held.is_active;
    state.guides = held.guides;
    update_accelerations(tree, c.positions, c.forces, state);
    return state;
}

AssemblyTree tree_of(const TorsionCase& c) {
    return build_assembly_tree(c.bodies, c.masses, c.positions);
}

double worst_against_dense(const TorsionCase& c, const Held& held) {
    const AssemblyTree tree = tree_of(c);
    return test::worst_difference(state_of(c, tree, held), test::dense_accelerations(c, held));
}

}  // namespace

TEST_CASE("the two slow ways to accelerations agree with each other", "[assembly][passes]") {
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
        const TorsionCase c = test::torsion_case(seed, 30, TorsionShape::Tree);
        for (const Held& held : {test::all_free(c), test::some_held(c, seed, 0.5)}) {
            const TorsionAccelerations a = test::dense_accelerations(c, held);
            const TorsionAccelerations b = test::recursive_accelerations(c, held);
            for (std::size_t i = 0; i < a.joints.size(); ++i) {
                CHECK(a.joints[i] == Approx(b.joints[i]).margin(1e-12 * test::rms_of(a.joints)));
            }
            for (std::size_t i = 0; i < a.bases.size(); ++i) {
                CHECK((a.bases[i] - b.bases[i]).norm() <= 1e-12 * (1 + a.bases[i].norm()));
            }
        }
    }
}

TEST_CASE("small trees accelerate as the mass matrix of all joints says", "[assembly][passes]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (std::uint32_t seed = 0; seed < 25; ++seed) {
        const std::size_t bodies = seed < 8 ? seed + 1 : 2 * seed + 2;
        const TorsionCase c = test::torsion_case(seed, bodies, shape);
        INFO(bodies << " bodies, seed " << seed);
        for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
            INFO("rigid " << share);
            CHECK(worst_against_dense(c, test::some_held(c, seed, share)) <= 1e-9);
        }
        CHECK(worst_against_dense(c, test::all_free(c)) <= 1e-9);
    }
}

TEST_CASE("molecules of one tree do not touch each other", "[assembly][passes]") {
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        INFO("seed " << seed);
        test::TorsionCaseBuilder builder(seed);
        for (const std::size_t bodies : {4, 1, 12, 2}) builder.add_molecule(bodies);
        const TorsionCase c = builder.take();

        CHECK(worst_against_dense(c, test::all_free(c)) <= 1e-9);
        CHECK(worst_against_dense(c, test::some_held(c, seed, 0.4)) <= 1e-9);
    }
}

TEST_CASE("large trees accelerate as the recursion in long double says",
          "[assembly][passes][slow]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (const std::size_t bodies : {200, 2000, 20001}) {
        const TorsionCase c = test::torsion_case(1, bodies, shape);
        const AssemblyTree tree = tree_of(c);
        INFO(bodies << " bodies of shape " << static_cast<int>(shape));
        for (const double share : {0.0, 0.5}) {
            Held held = test::some_held(c, 2, share);
            held.is_active[0] = 1;
            const double error = test::worst_difference(state_of(c, tree, held),
                                                        test::recursive_accelerations(c, held));
            CHECK(error <= 1e-6);
        }
    }
}

TEST_CASE("proteins accelerate as Simbody and a dense solve say", "[assembly][passes]") {
    const auto folder = test::find_shared_data("reference");
    if (!folder) return;
    for (const char* const name : {"ala_dipeptide", "ubiquitin", "hiv_tl3_c36m"}) {
        const TorsionCase c = test::read_torsion_case(*folder, name);
        REQUIRE(!c.positions.empty());
        const AssemblyTree tree = tree_of(c);
        const AssemblyState state = state_of(c, tree, test::all_free(c));
        INFO(name);

        const double error =
            test::worst_difference(state, test::read_torsion_accelerations(*folder, name, c));
        // To which Simbody and the file agree; the file has twelve digits.
        CHECK(error <= 1e-8);
        const double exact =
            test::worst_difference(state, test::recursive_accelerations(c, test::all_free(c)));
        CHECK(exact <= 1e-9);
        std::size_t joins = 0, handles = 0;
        for (const AssemblyNode& node : tree.nodes) {
            joins += node.is_leaf() ? 0 : 1;
            handles += node.is_leaf() ? 0 : node.handles;
        }
        std::cout << fmt::format(
            "{}: {} joints, {} joins, {:.2f} handles a join, depth {}; worst {:.1e} of rms "
            "against the file, {:.1e} against the recursion in long double\n",
            name, c.bodies.joints(), joins, double(handles) / double(joins), tree.depth, error,
            exact);
    }
}

TEST_CASE("ions and molecules in line move as far as they can", "[assembly][passes]") {
    TorsionCase c;
    // An ion; and three atoms in line along x.
    c.bodies.bodies = {{}, {}};
    c.bodies.body_of = {0, 1, 1, 1};
    c.masses = {23, 16, 12, 16};
    c.positions = {{5, 5, 5}, {-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
    c.forces = {{23, 0, 46}, {0, 3, 0}, {0, 0, 0}, {4.4, -3, 4.4}};
    const AssemblyTree tree = tree_of(c);

    const AssemblyState state = state_of(c, tree, test::all_free(c));

    CHECK((state.base_acceleration[0] - (Vec6() << 0, 0, 0, 1, 0, 2).finished()).norm() < 1e-12);
    // Torque (0, -4.4, -6) by an inertia of 32; force (4.4, 0, 4.4) by a mass of 44.
    const Vec6 expected = (Vec6() << 0, -4.4 / 32, -6.0 / 32, 0.1, 0, 0.1).finished();
    CHECK((state.base_acceleration[1] - expected).norm() < 1e-12);

    Held held = test::all_free(c);
    held.guides[0].guide = held.guides[1].guide = BaseGuide::Whole;
    held.guides[1].acceleration = (Vec6() << 0, 1, 0, 0, 0, 1).finished();
    const AssemblyState guided = state_of(c, tree, held);
    CHECK((guided.base_force[0] - (Vec6() << 0, 0, 0, -23, 0, -46).finished()).norm() < 1e-9);
    const Vec6 push = (Vec6() << 0, 32 + 4.4, 6, -4.4, 0, 44 - 4.4).finished();
    CHECK((guided.base_force[1] - push).norm() < 1e-9);
}

TEST_CASE("what holds a base is what it takes to do so", "[assembly][passes]") {
    const TorsionCase c = test::torsion_case(3, 12, TorsionShape::Tree);
    const AssemblyTree tree = tree_of(c);
    Held held = test::all_free(c);
    held.is_active.assign(held.is_active.size(), 0);

    // All rigid and fixed: against all forces on atoms.
    const AssemblyState state = state_of(c, tree, held);
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    const Vec3 centre = test::centres_of(c)[0];
    for (std::size_t i = 0; i < c.forces.size(); ++i) {
        force += c.forces[i];
        torque += (c.positions[i] - centre).cross(c.forces[i]);
    }

    CHECK((state.points[0] - centre).norm() < 1e-12);
    CHECK((state.base_force[0].tail<3>() + force).norm() < 1e-9 * force.norm());
    CHECK((state.base_force[0].head<3>() + torque).norm() < 1e-9 * torque.norm());
    CHECK(state.base_acceleration[0].norm() < 1e-12);
}
