#include "assembly/selection.h"

#include "tests/support/torsion_molecules.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
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
    update_metric(r.tree, r.state, {}, r.metric);
    return r;
}

// As if there had been no selection before.
void select(Ready& r, const SelectionLimits& limits) {
    r.selection = build_joint_selection(r.tree);
    select_joints(r.tree, r.metric, {}, limits, r.state, r.selection);
}

// What all joints and bases do that are chosen, or that are not.
double sum_of_squares(const Ready& r, bool chosen) {
    double sum = 0;
    for (std::size_t b = 0; b < r.c.bodies.bodies.size(); ++b) {
        if ((r.selection.is_active[b] != 0) != chosen) continue;
        sum += r.state.joint_acceleration[b] * r.state.joint_acceleration[b];
        if (r.c.bodies.is_base(b)) sum += r.metric.bases[r.tree.molecule_of[b]];
    }
    return sum;
}

std::size_t freedom_chosen(const Ready& r) {
    std::size_t count = 0;
    for (std::size_t b = 0; b < r.c.bodies.bodies.size(); ++b) {
        if (r.selection.is_active[b] != 0) count += r.c.bodies.is_base(b) ? 6 : 1;
    }
    return count;
}

// With the metric and the selection of a step before still there.
void select_again(Ready& r, const MetricWeights& weights, const SelectionLimits& limits) {
    update_metric(r.tree, r.state, weights, r.metric);
    select_joints(r.tree, r.metric, {}, limits, r.state, r.selection);
}

std::vector<double> fluctuating(std::size_t bodies, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0.8, 1.2);
    std::vector<double> factors;
    for (std::size_t b = 0; b < bodies; ++b) factors.push_back(uniform(random));
    return factors;
}

}  // namespace

TEST_CASE("as many degrees of freedom are chosen as were asked for", "[assembly][selection]") {
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
        Ready r = ready(seed);
        const double all = sum_of_squares(r, false);
        double before = all * 1.0000001;
        for (const std::size_t count : {0, 1, 2, 5, 20, 50, 63, 75, 100}) {
            INFO(count << " degrees of freedom, seed " << seed);
            select(r, {.degrees_of_freedom = count});

            // 63 joints and two free bases.
            CHECK(r.selection.degrees_of_freedom == std::min<std::size_t>(count, 75));
            CHECK(freedom_chosen(r) == r.selection.degrees_of_freedom);
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
        CHECK(r.selection.degrees_of_freedom < 75);
        CHECK(sum_of_squares(r, true) >= (1 - share) * all * (1 - 1e-9));
        const std::size_t enough = r.selection.degrees_of_freedom;
        select(r, {.degrees_of_freedom = enough - 1});
        CHECK(r.selection.neglected > share * all);
    }
}

TEST_CASE("a step's time allows so many degrees of freedom", "[assembly][selection]") {
    const StepCost cost{12, 2.5};

    CHECK(degrees_of_freedom_within(112, cost) == 40);
    CHECK(degrees_of_freedom_within(114.4, cost) == 40);
    CHECK(degrees_of_freedom_within(114.6, cost) == 41);
    CHECK(degrees_of_freedom_within(12, cost) == 0);
    CHECK(degrees_of_freedom_within(3, cost) == 0);
}

TEST_CASE("chosen joints are a connected region from the roots", "[assembly][selection]") {
    Ready r = ready(4);

    select(r, {.degrees_of_freedom = 17});

    for (std::size_t i = 0; i < r.tree.nodes.size(); ++i) {
        const AssemblyNode& node = r.tree.nodes[i];
        if (node.is_leaf() || node.parent == no_node) continue;
        const std::uint32_t above = r.tree.nodes[node.parent].link;
        const std::size_t bodies = r.c.bodies.bodies.size();
        if (node.link >= bodies || above >= bodies) continue;  // a seam counts as nothing
        if (r.selection.is_active[node.link] != 0) CHECK(r.selection.is_active[above] != 0);
    }
}

TEST_CASE("joints and bases that may not move are not chosen", "[assembly][selection]") {
    Ready r = ready(2);
    for (std::size_t b = 0; b < 40; ++b) r.state.is_active[b] = 0;
    update_accelerations(r.tree, r.c.positions, r.c.forces, r.state);
    update_metric(r.tree, r.state, {}, r.metric);

    select(r, {});

    CHECK(r.selection.degrees_of_freedom == 24 + 6);
    CHECK(r.selection.is_active == r.state.is_active);
}

TEST_CASE("a base counts as many degrees of freedom as its guide leaves", "[assembly][selection]") {
    Ready r = ready(6);
    // The first may only turn, the second has nothing to choose.
    r.state.guides[0].guide = BaseGuide::Point;
    r.state.guides[1].guide = BaseGuide::Whole;
    update_accelerations(r.tree, r.c.positions, r.c.forces, r.state);
    update_metric(r.tree, r.state, {}, r.metric);

    select(r, {});
    CHECK(r.selection.degrees_of_freedom == 63 + 3);
    CHECK(r.selection.is_active == r.state.is_active);

    // It takes part in the queue with what it does.
    std::vector<double> factors(65, 1);
    factors[r.tree.bases[0]] = 1e6;
    r.selection = build_joint_selection(r.tree);
    select_again(r, {MetricWeight::Plain, factors}, {.degrees_of_freedom = 3});
    CHECK(r.selection.is_active[r.tree.bases[0]] == 1);
    CHECK(std::ranges::count(r.selection.is_active, 1) == 2);
    // What does not fit is passed over.
    r.selection = build_joint_selection(r.tree);
    select_again(r, {MetricWeight::Plain, factors}, {.degrees_of_freedom = 2});
    CHECK(r.selection.is_active[r.tree.bases[0]] == 0);
    CHECK(r.selection.degrees_of_freedom == 2);
    CHECK(r.selection.neglected > r.metric.bases[0]);
}

TEST_CASE("factors wake joints where they are large", "[assembly][selection]") {
    Ready r = ready(3);
    std::vector<double> factors(65, 1e-9);
    std::fill(factors.begin() + 40, factors.end(), 1);  // the second molecule

    r.selection = build_joint_selection(r.tree);
    select_again(r, {MetricWeight::Inertia, factors}, {.degrees_of_freedom = 20});

    for (std::size_t b = 0; b < 40; ++b) CHECK(r.selection.is_active[b] == 0);
}

TEST_CASE("joints do not come and go while metrics fluctuate by 20 %", "[assembly][selection]") {
    const bool is_by_number = GENERATE(true, false);
    std::size_t flickers = 0;
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        Ready r = ready(seed);
        std::mt19937 random(seed);
        SelectionLimits limits;
        if (is_by_number) limits.degrees_of_freedom = 20;
        if (!is_by_number) limits.neglected = 0.1 * sum_of_squares(r, false);
        select(r, limits);
        const std::vector<std::uint8_t> chosen = r.selection.is_active;
        for (int step = 0; step < 20; ++step) {
            const std::vector<double> factors = fluctuating(65, random);
            select_again(r, {MetricWeight::Plain, factors}, limits);
            if (is_by_number) CHECK(r.selection.is_active == chosen);
            // By tolerance more may be chosen when there is more, and stays.
            for (std::size_t b = 0; b < 65; ++b) {
                CHECK((chosen[b] == 0 || r.selection.is_active[b] != 0));
            }

            // Without an advantage they would come and go.
            JointSelection fresh = build_joint_selection(r.tree);
            select_joints(r.tree, r.metric, {}, limits, r.state, fresh);
            flickers += fresh.is_active != chosen ? 1 : 0;
        }
    }
    CHECK(flickers > 0);
}

TEST_CASE("a real change is followed at once", "[assembly][selection]") {
    Ready r = ready(5);
    const SelectionLimits limits{.degrees_of_freedom = 20};
    select(r, limits);
    const std::vector<std::uint8_t> before = r.selection.is_active;
    std::ranges::reverse(r.c.forces);
    for (Vec3& force : r.c.forces) force *= 3;
    update_accelerations(r.tree, r.c.positions, r.c.forces, r.state);

    select_again(r, {}, limits);

    CHECK(r.selection.is_active != before);
    // Of what would be chosen afresh, all that does far more than the least that is chosen.
    Ready fresh = r;
    select(fresh, limits);
    CHECK(r.selection.neglected <= limits.advantage * fresh.selection.neglected);
}

TEST_CASE("single joints are those that count most by themselves", "[assembly][selection]") {
    Ready r = ready(GENERATE(11U, 12U, 13U));
    const auto weight = GENERATE(MetricWeight::Plain, MetricWeight::Inertia);
    const std::size_t count = GENERATE(std::size_t{0}, std::size_t{1}, std::size_t{10},
                                       std::size_t{40}, std::size_t{1000});
    std::mt19937 random(9);
    const std::vector<double> factors = fluctuating(r.c.bodies.bodies.size(), random);
    const MetricWeights weights{weight, factors};
    update_metric(r.tree, r.state, weights, r.metric);
    // All of them, from what the passes found, the largest first.
    struct Value {
        double each;
        std::size_t body, freedom;
    };
    std::vector<Value> values;
    double total = 0;
    for (const AssemblyNode& node : r.tree.nodes) {
        if (node.is_leaf() || node.link >= r.c.bodies.bodies.size()) continue;
        const double a = r.state.joint_acceleration[node.link];
        const double inertia =
            weight == MetricWeight::Inertia ? 1 / r.state.joints[node.part].D : 1;
        values.push_back({inertia * factors[node.link] * a * a, node.link, 1});
        total += values.back().each;
    }
    for (std::size_t m = 0; m < r.tree.bases.size(); ++m) {
        values.push_back({r.metric.bases[m] / 6, r.tree.bases[m], 6});
        total += r.metric.bases[m];
    }
    std::ranges::sort(values, std::ranges::greater{}, &Value::each);
    std::vector<std::uint8_t> expected(r.c.bodies.bodies.size(), 0);
    std::size_t left = count;
    double neglected = total;
    for (const Value& value : values) {
        if (value.freedom > left) continue;
        expected[value.body] = 1;
        left -= value.freedom;
        neglected -= value.each * static_cast<double>(value.freedom);
    }

    r.selection = build_joint_selection(r.tree);
    SelectionLimits limits;
    limits.shape = SelectionShape::Single;
    limits.degrees_of_freedom = count;
    select_joints(r.tree, r.metric, weights, limits, r.state, r.selection);

    CHECK(r.selection.is_active == expected);
    CHECK(r.selection.total == Approx(total));
    CHECK(r.selection.neglected == Approx(neglected).margin(1e-9 * total));
}
