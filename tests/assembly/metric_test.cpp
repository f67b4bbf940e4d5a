#include "assembly/metric.h"

#include "tests/support/shared_data.h"
#include "tests/support/torsion_held.h"
#include "tests/support/torsion_reference.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <span>
#include <vector>

using namespace palpa;
using test::Held;
using test::TorsionCase;
using test::TorsionShape;

namespace {

struct Sums {
    double of_squares = 0;
    std::size_t joints = 0;
};

// Of what lies below each node, from the accelerations themselves.
std::vector<Sums> sums_below(const AssemblyTree& tree, const AssemblyState& state,
                             const MetricWeights& weights) {
    std::vector<Sums> sums(tree.nodes.size());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const AssemblyNode& node = tree.nodes[i];
        if (node.is_leaf()) continue;
        sums[i].of_squares = sums[node.a].of_squares + sums[node.b].of_squares;
        sums[i].joints = sums[node.a].joints + sums[node.b].joints;
        if (node.link >= tree.bodies.bodies.size() || state.is_active[node.link] == 0) continue;
        const double acceleration = state.joint_acceleration[node.link];
        double factor = weights.weight == MetricWeight::Plain ? 1 : 1 / state.joints[node.part].D;
        if (!weights.factors.empty()) factor *= weights.factors[node.link];
        sums[i].of_squares += factor * acceleration * acceleration;
        ++sums[i].joints;
    }
    return sums;
}

// Each weight, with and without factors.
std::vector<MetricWeights> all_weights(std::span<const double> factors) {
    return {{MetricWeight::Plain, {}},
            {MetricWeight::Inertia, {}},
            {MetricWeight::Plain, factors},
            {MetricWeight::Inertia, factors}};
}

std::vector<double> some_factors(std::size_t bodies) {
    std::mt19937 random(7);
    std::vector<double> factors;
    for (std::size_t b = 0; b < bodies; ++b) {
        factors.push_back(static_cast<double>(random() % 1000) / 100);
    }
    return factors;
}

void check_metric(const TorsionCase& c, const Held& held) {
    const AssemblyTree tree = build_assembly_tree(c.bodies, c.masses, c.positions);
    AssemblyState state = build_assembly_state(tree);
    AccelerationMetric metric = build_acceleration_metric(tree);
    state.is_active = held.is_active;
    state.guides = held.guides;
    update_accelerations(tree, c.positions, c.forces, state);
    const std::vector<double> factors = some_factors(c.bodies.bodies.size());
    for (const MetricWeights& weights : all_weights(factors)) {
        update_metric(tree, state, weights, metric);

        const std::vector<Sums> sums = sums_below(tree, state, weights);
        double all = 0;
        for (const std::uint32_t root : tree.roots) all += sums[root].of_squares;
        for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
            const double mean =
                sums[i].joints == 0 ? 0 : all / static_cast<double>(c.bodies.joints());
            CHECK(find_metric(tree, state, metric, i) ==
                  Approx(sums[i].of_squares).epsilon(1e-9).margin(1e-9 * mean));
        }
    }
}

// Turns all that lies beyond a body's joint.
void turn_joint(TorsionCase& c, std::uint32_t body, double angle) {
    const std::span<const Body> bodies = c.bodies.bodies;
    const auto [j, k] = bodies[body].axis;
    const Vec3 point = c.positions[k], axis = (point - c.positions[j]).normalized();
    const Eigen::AngleAxisd turn(angle, axis);
    std::vector<std::uint8_t> is_beyond(bodies.size(), 0);
    for (std::uint32_t b = body; b < bodies.size(); ++b) {
        is_beyond[b] = b == body || (!c.bodies.is_base(b) && is_beyond[bodies[b].parent] != 0);
    }
    for (std::size_t i = 0; i < c.positions.size(); ++i) {
        if (is_beyond[c.bodies.body_of[i]] != 0)
            c.positions[i] = point + turn * (c.positions[i] - point);
    }
}

void check_same(const AssemblyState& state, const AccelerationMetric& metric,
                const AssemblyState& whole, const AccelerationMetric& whole_metric) {
    CHECK(state.phi == whole.phi);
    CHECK(state.b == whole.b);
    CHECK(metric.psi == whole_metric.psi);
    CHECK(metric.p == whole_metric.p);
    CHECK(metric.eta == whole_metric.eta);
    CHECK(metric.bases == whole_metric.bases);
}

// The part of a base's acceleration that its guide leaves, at the centre of mass.
Vec6 free_motion(const TorsionCase& c, const AssemblyState& state, const GuidedBase& base) {
    Vec6 motion = state.base_acceleration[0];
    if (base.guide != BaseGuide::Point) return motion;
    const Vec3 centre = test::centres_of(c)[0];
    const Vec3 turn = motion.head<3>(), arm = base.point.value_or(centre) - centre;
    motion.tail<3>() = -turn.cross(arm);
    return motion;
}

}  // namespace

TEST_CASE("the metric of every part is the sum of squares below it", "[assembly][metric]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        const std::size_t bodies = 1 + 7 * seed;
        INFO(bodies << " bodies of shape " << static_cast<int>(shape));
        const TorsionCase c = test::torsion_case(seed, bodies, shape);
        check_metric(c, test::all_free(c));
        check_metric(c, test::some_held(c, seed, 0.33));
    }
    const TorsionCase large = test::torsion_case(1, 1000, shape);
    check_metric(large, test::all_free(large));
}

TEST_CASE("the metric of every part of a protein is the sum of squares below it",
          "[assembly][metric]") {
    const auto folder = test::find_shared_data("reference");
    if (!folder) return;
    for (const char* const name : {"ala_dipeptide", "ubiquitin", "hiv_tl3_c36m"}) {
        INFO(name);
        const TorsionCase c = test::read_torsion_case(*folder, name);
        check_metric(c, test::all_free(c));
        check_metric(c, test::some_held(c, 1, 0.33));
    }
}

TEST_CASE("what is renewed in part is to the bit what everything anew is", "[assembly][metric]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    constexpr std::uint32_t bodies = 200;
    TorsionCase c = test::torsion_case(3, bodies, shape);
    const AssemblyTree tree = build_assembly_tree(c.bodies, c.masses, c.positions);
    AssemblyState state = build_assembly_state(tree);
    AccelerationMetric metric = build_acceleration_metric(tree);
    const std::vector<double> factors = some_factors(bodies);
    std::vector<MetricWeights> weights = all_weights(factors);
    update_bodies(tree, c.positions, c.forces, state);
    upward_pass(tree, state);
    update_metric(tree, state, weights[0], metric);
    for (std::uint32_t round = 0; round < 24; ++round) {
        INFO("round " << round);
        const std::uint32_t body = 1 + (37 * round) % (bodies - 1);
        if (round % 3 == 1) turn_joint(c, body, 0.1);
        if (round % 3 == 2) c.forces[tree.atoms[tree.first_atom[body]]] += Vec3(1, -2, 0.5);

        update_changed_bodies(tree, c.positions, c.forces, state);
        const auto stale = std::ranges::count_if(
            state.changes, [](Change change) { return change != Change::None; });
        upward_pass(tree, state);
        update_metric(tree, state, weights[round / 6], metric);

        AssemblyState whole = build_assembly_state(tree);
        AccelerationMetric whole_metric = build_acceleration_metric(tree);
        update_bodies(tree, c.positions, c.forces, whole);
        upward_pass(tree, whole);
        update_metric(tree, whole, weights[round / 6], whole_metric);
        check_same(state, metric, whole, whole_metric);
        // Nothing; something; the copies of a body and the parts that they are in.
        CHECK((stale > 0) == (round % 3 != 0));
        if (round % 3 == 2) CHECK(stale <= tree.copies[body] * static_cast<double>(tree.depth + 1));
    }
}

TEST_CASE("a base counts by its parts or by the work of pushing it", "[assembly][metric]") {
    const auto guide = GENERATE(BaseGuide::None, BaseGuide::Point, BaseGuide::Whole);
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
        const TorsionCase c = test::torsion_case(seed, 1 + 5 * seed, TorsionShape::Tree);
        const AssemblyTree tree = build_assembly_tree(c.bodies, c.masses, c.positions);
        AssemblyState state = build_assembly_state(tree), pushed = state;
        AccelerationMetric metric = build_acceleration_metric(tree);
        GuidedBase& base = state.guides[0];
        base.guide = guide;
        base.acceleration << 1, -2, 3, 0.1, 0.2, -0.5;
        if (seed % 2 == 0) base.point = c.positions[1];
        update_accelerations(tree, c.positions, c.forces, state);
        const Vec6 motion = free_motion(c, state, base);
        const std::vector<double> factors(c.bodies.bodies.size(), 3);

        update_metric(tree, state, {MetricWeight::Plain, factors}, metric);

        // From the atoms.
        const Vec3 centre = test::centres_of(c)[0];
        double mass = 0, moment = 0;
        for (std::size_t i = 0; i < c.masses.size(); ++i) {
            mass += c.masses[i];
            moment += c.masses[i] * (c.positions[i] - centre).squaredNorm();
        }
        const double turn = motion.head<3>().squaredNorm();
        const double shift = motion.tail<3>().squaredNorm() / std::max(moment / mass, 1.0);
        const double plain = guide == BaseGuide::None    ? turn + shift
                             : guide == BaseGuide::Point ? turn
                                                         : 0;
        CHECK(metric.bases[0] == Approx(3 * plain).epsilon(1e-9));

        update_metric(tree, state, {MetricWeight::Inertia, factors}, metric);

        // The force that makes the base do that once more, with all joints open.
        pushed.guides[0].guide = BaseGuide::Whole;
        pushed.guides[0].acceleration = state.base_acceleration[0] + motion;
        update_accelerations(tree, c.positions, c.forces, pushed);
        const Vec6 push = pushed.base_force[0] - state.base_force[0];
        const double inertia = guide == BaseGuide::Whole ? 0 : motion.dot(push);
        CHECK(metric.bases[0] == Approx(3 * inertia).epsilon(1e-9));
    }
}
