#include "assembly/selection.h"

#include "tests/support/torsion_molecules.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <vector>

using namespace palpa;
using test::TorsionCase;

namespace {

// Two molecules with all joints active, ready to choose from.
struct Ready {
    TorsionCase c;
    AssemblyTree tree;
    AssemblyState state;
    AccelerationMetric metric;
    JointSelection selection;
};

Ready ready(std::uint32_t seed) {
    test::TorsionCaseBuilder builder(seed);
    builder.add_molecule(40);
    builder.add_molecule(25);
    Ready r{builder.take(), {}, {}, {}, {}};
    r.tree = build_assembly_tree(r.c.bodies, r.c.masses, r.c.positions);
    r.state = build_assembly_state(r.tree);
    r.metric = build_acceleration_metric(r.tree);
    r.selection = build_joint_selection(r.tree);
    update_accelerations(r.tree, r.c.positions, r.c.forces, r.state);
    update_metric(r.tree, r.state, MetricWeight::Plain, r.metric);
    return r;
}

void select(Ready& r, const SelectionLimits& limits) {
    select_joints(r.tree, r.metric, limits, r.state, r.selection);
}

double sum_of_squares(const Ready& r, bool chosen) {
    double sum = 0;
    for (std::size_t b = 0; b < r.c.bodies.bodies.size(); ++b) {
        if ((r.selection.is_active[b] != 0) != chosen) continue;
        sum += r.state.joint_acceleration[b] * r.state.joint_acceleration[b];
    }
    return sum;
}

std::size_t joints_chosen(const Ready& r) {
    std::size_t count = 0;
    for (std::size_t b = 0; b < r.c.bodies.bodies.size(); ++b) {
        if (!r.c.bodies.is_base(b) && r.selection.is_active[b] != 0) ++count;
    }
    return count;
}

}  // namespace

TEST_CASE("as many joints are chosen as were asked for", "[assembly][selection]") {
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
        Ready r = ready(seed);
        const double all = sum_of_squares(r, false);
        double before = all * 1.0000001;
        for (const std::size_t count : {0, 1, 2, 5, 20, 50, 63, 100}) {
            INFO(count << " joints, seed " << seed);
            select(r, {.joints = count});

            CHECK(r.selection.joints == std::min<std::size_t>(count, 63));
            CHECK(joints_chosen(r) == r.selection.joints);
            CHECK(r.selection.total == Approx(all));
            // What is neglected is what the others would do.
            CHECK(r.selection.neglected == Approx(sum_of_squares(r, false)).margin(1e-9 * all));
            CHECK(r.selection.neglected <= before);
            before = r.selection.neglected;
        }
    }
}

TEST_CASE("joints are chosen until little enough is neglected", "[assembly][selection]") {
    Ready r = ready(9);
    const double all = sum_of_squares(r, false);
    for (const double share : {0.9, 0.5, 0.1, 0.01}) {
        INFO("share " << share);
        select(r, {.neglected = share * all});

        CHECK(r.selection.neglected <= share * all);
        CHECK(r.selection.joints < 63);
        CHECK(sum_of_squares(r, true) >= (1 - share) * all * (1 - 1e-9));
        const std::size_t enough = r.selection.joints;
        select(r, {.joints = enough - 1});
        CHECK(r.selection.neglected > share * all);
    }
}

TEST_CASE("chosen joints are a connected region from the roots", "[assembly][selection]") {
    Ready r = ready(4);

    select(r, {.joints = 17});

    for (std::size_t i = 0; i < r.tree.nodes.size(); ++i) {
        const AssemblyNode& node = r.tree.nodes[i];
        if (node.is_leaf() || node.parent == no_node) continue;
        const std::uint32_t above = r.tree.nodes[node.parent].link;
        const std::size_t bodies = r.c.bodies.bodies.size();
        if (node.link >= bodies || above >= bodies) continue;  // a seam counts as nothing
        if (r.selection.is_active[node.link] != 0) CHECK(r.selection.is_active[above] != 0);
    }
}

TEST_CASE("joints that were rigid are not chosen, and bases stay as they are",
          "[assembly][selection]") {
    Ready r = ready(2);
    for (std::size_t b = 0; b < 40; ++b) r.state.is_active[b] = 0;
    update_accelerations(r.tree, r.c.positions, r.c.forces, r.state);
    update_metric(r.tree, r.state, MetricWeight::Plain, r.metric);

    select(r, {});

    CHECK(r.selection.joints == 24);
    CHECK(r.selection.is_active == r.state.is_active);
}
