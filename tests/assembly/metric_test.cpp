#include "assembly/metric.h"

#include "tests/support/torsion_molecules.h"

#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace palpa;
using test::TorsionCase;
using test::TorsionShape;

namespace {

struct Sums {
    double of_squares = 0;
    std::size_t joints = 0;
};

// Of what lies below each node, from the accelerations themselves.
std::vector<Sums> sums_below(const AssemblyTree& tree, const AssemblyState& state,
                             MetricWeight weight) {
    std::vector<Sums> sums(tree.nodes.size());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const AssemblyNode& node = tree.nodes[i];
        if (node.is_leaf()) continue;
        sums[i].of_squares = sums[node.a].of_squares + sums[node.b].of_squares;
        sums[i].joints = sums[node.a].joints + sums[node.b].joints;
        if (node.link >= tree.bodies.bodies.size() || state.is_active[node.link] == 0) continue;
        const double acceleration = state.joint_acceleration[node.link];
        const double factor = weight == MetricWeight::Plain ? 1 : 1 / state.joints[node.part].D;
        sums[i].of_squares += factor * acceleration * acceleration;
        ++sums[i].joints;
    }
    return sums;
}

void check_metric(const TorsionCase& c, const std::vector<std::uint8_t>& is_active) {
    const AssemblyTree tree = build_assembly_tree(c.bodies, c.masses, c.positions);
    AssemblyState state = build_assembly_state(tree);
    AccelerationMetric metric = build_acceleration_metric(tree);
    state.is_active = is_active;
    update_accelerations(tree, c.positions, c.forces, state);
    for (const MetricWeight weight : {MetricWeight::Plain, MetricWeight::Inertia}) {
        update_metric(tree, state, weight, metric);

        const std::vector<Sums> sums = sums_below(tree, state, weight);
        const double all = sums[tree.roots[0]].of_squares;
        for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
            const double mean =
                sums[i].joints == 0 ? 0 : all / static_cast<double>(c.bodies.joints());
            CHECK(find_metric(tree, state, metric, i) ==
                  Approx(sums[i].of_squares).epsilon(1e-9).margin(1e-9 * mean));
        }
    }
}

}  // namespace

TEST_CASE("the metric of every part is the sum of squares below it", "[assembly][metric]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        const std::size_t bodies = 1 + 7 * seed;
        INFO(bodies << " bodies of shape " << static_cast<int>(shape));
        const TorsionCase c = test::torsion_case(seed, bodies, shape);
        std::vector<std::uint8_t> is_active(bodies, 1);
        check_metric(c, is_active);

        std::mt19937 random(seed);
        for (std::uint8_t& one : is_active) one = random() % 3 != 0 ? 1 : 0;
        check_metric(c, is_active);
    }
    check_metric(test::torsion_case(1, 1000, shape), std::vector<std::uint8_t>(1000, 1));
}
