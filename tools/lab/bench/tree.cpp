#include "tools/lab/bench/tree.h"

#include "assembly/bodies.h"
#include "assembly/hybrid.h"
#include "assembly/joints.h"
#include "assembly/metric.h"
#include "assembly/passes.h"
#include "assembly/selection.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t few = 40;  // joints, as in the paper

struct TreeBench {
    AssemblyTree tree;
    AssemblyState state;
    AccelerationMetric metric;
    JointSelection selection;
    std::vector<Vec3> positions, forces;
};

TreeBench build_tree_bench(const Connectivity& connectivity, std::vector<Vec3> positions,
                           const JointRules& rules) {
    const TorsionBodies bodies = build_bodies(connectivity, build_joints(connectivity, rules));
    TreeBench bench;
    bench.tree = build_assembly_tree(bodies, connectivity.mass, positions);
    bench.state = build_assembly_state(bench.tree);
    for (GuidedBase& base : bench.state.guides) base.guide = BaseGuide::Whole;
    bench.metric = build_acceleration_metric(bench.tree);
    bench.selection = build_joint_selection(bench.tree);
    bench.positions = std::move(positions);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < bench.positions.size(); ++i) {
        const auto component = [&] { return static_cast<double>(random() % 2001) / 100 - 10; };
        const double x = component(), y = component(), z = component();
        bench.forces.emplace_back(x, y, z);
    }
    return bench;
}

// How far the root's metric, which comes up, is from the squares that come down.
double metric_error(const TreeBench& bench) {
    double sum = 0, metric = 0;
    for (const double a : bench.state.joint_acceleration) sum += a * a;
    for (const std::uint32_t root : bench.tree.roots) {
        metric += find_metric(bench.tree, bench.state, bench.metric, root);
    }
    return std::abs(metric - sum) / sum;
}

// Falls with the distance of each body to the last molecule, as if that were in the hand.
std::vector<double> near_hand(const TreeBench& bench) {
    const Vec3 hand = bench.state.points[bench.tree.bases.back()];
    std::vector<double> factors;
    for (const BodyState& body : bench.state.bodies) {
        factors.push_back(1 / (1 + (body.centre - hand).squaredNorm() / 100));
    }
    return factors;
}

// Of the few joints against a full pass with the others rigid, of the rms.
double hybrid_error(const TreeBench& bench, const HybridTree& hybrid,
                    const HybridState& few_state) {
    AssemblyState state = bench.state;
    state.is_active = bench.selection.is_active;
    update_accelerations(bench.tree, bench.positions, bench.forces, state);
    double worst = 0, squares = 0;
    for (std::size_t c = 0; c < hybrid.body_of.size(); ++c) {
        const double expected = state.joint_acceleration[hybrid.body_of[c]];
        worst = std::max(worst, std::abs(few_state.passes.joint_acceleration[c] - expected));
        squares += expected * expected;
    }
    return worst / std::sqrt(squares / static_cast<double>(hybrid.tree.bodies.joints()));
}

// The joints that were chosen, the rest in rigid clusters.
template <class Time>
void add_hybrid_rows(TreeBench& bench, const Time& time, std::vector<BenchRow>& rows) {
    const std::string name = fmt::format("/active={}", few);
    HybridTree hybrid = build_hybrid_tree(bench.tree, bench.selection.is_active, bench.positions);
    HybridState state = build_hybrid_state(hybrid, bench.selection.is_active, bench.state.guides);
    AccelerationMetric metric = build_acceleration_metric(hybrid.tree);
    time(name + "/build", [&] {
        hybrid = build_hybrid_tree(bench.tree, bench.selection.is_active, bench.positions);
        state = build_hybrid_state(hybrid, bench.selection.is_active, bench.state.guides);
    });
    time(name + "/wrenches",
         [&] { update_wrenches(hybrid, bench.positions, bench.forces, state); });
    time(name + "/passes", [&] { update_accelerations(hybrid, state); });
    rows.back().error = hybrid_error(bench, hybrid, state);
    rows.back().error_unit = "of rms";
    rows.back().reference = "the full passes";
    time(name + "/passes+metric", [&] {
        update_accelerations(hybrid, state);
        update_metric(hybrid.tree, state.passes, {}, metric);
    });
    std::vector<Vec3> positions = bench.positions;
    const std::vector<double> turns(hybrid.clusters.size(), 1e-6);
    const std::vector<Vec6> moves(hybrid.tree.bases.size(), Vec6::Zero());
    time(name + "/move", [&] {
        move_clusters(hybrid, turns, moves, state);
        update_positions(hybrid, state, positions);
    });
}

void add_rows(const std::string& name, TreeBench& bench, std::vector<BenchRow>& rows) {
    const auto time = [&](const std::string& what, const auto& work) {
        rows.push_back({name + what, sample(41, 1e6, work), "us"});
    };
    AssemblyState& state = bench.state;
    time("/bodies", [&] { update_bodies(bench.tree, bench.positions, bench.forces, state); });
    time("/passes", [&] {
        upward_pass(bench.tree, state);
        downward_pass(bench.tree, state);
    });
    if (bench.tree.bodies.joints() == 0) return;
    time("/metric", [&] { update_metric(bench.tree, state, {}, bench.metric); });
    rows.back().error = metric_error(bench);
    rows.back().error_unit = "relative";
    rows.back().reference = "sum of squared accelerations";
    const std::vector<double> factors = near_hand(bench);
    const std::array<std::pair<const char*, MetricWeights>, 2> weights{
        {{"near-hand", {MetricWeight::Inertia, factors}}, {"plain", {MetricWeight::Plain, {}}}}};
    for (const auto& [weight, counts] : weights) {
        update_metric(bench.tree, state, counts, bench.metric);
        bench.selection = build_joint_selection(bench.tree);
        time(fmt::format("/select={}/{}", few, weight), [&] {
            select_joints(bench.tree, bench.metric, {}, {.degrees_of_freedom = few}, state,
                          bench.selection);
        });
        rows.back().reference =
            fmt::format("{:.1f} % of the squares neglected",
                        100 * bench.selection.neglected / bench.selection.total);
    }
    add_hybrid_rows(bench, time, rows);
}

// A chain of CH2 that winds like a helix, with a CH3 at each end: n joints have n + 3 carbons.
Connectivity polymer_of(std::size_t joints, std::vector<Vec3>& positions) {
    Connectivity result;
    result.file = "polymer";
    const auto add = [&](double mass, const Vec3& position) {
        result.names.push_back({"P", "CH2", "1", mass > 2 ? "C" : "H"});
        result.mass.push_back(mass);
        positions.push_back(position);
        return static_cast<std::uint32_t>(positions.size() - 1);
    };
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < joints + 3; ++i) {
        // Bonds of 1.5 Å that meet at 113 degrees.
        const double turn = 1.9 * static_cast<double>(i), rise = 0.9 * static_cast<double>(i);
        const Vec3 out(std::cos(turn), std::sin(turn), 0), along(0, 0, 1);
        const Vec3 side = along.cross(out), carbon = 0.75 * out + rise * along;
        const std::uint32_t c = add(12.011, carbon);
        if (i > 0) result.bonds.push_back({before, c});
        before = c;
        std::vector<Vec3> directions{0.6 * out + 0.8 * side, 0.6 * out - 0.8 * side};
        if (i == 0) directions.push_back(-along);
        if (i == joints + 2) directions.push_back(along);
        for (const Vec3& direction : directions) {
            result.bonds.push_back({c, add(1.008, carbon + 1.09 * direction.normalized())});
        }
    }
    return result;
}

// The least disturbed run of a row.
double least_of(const std::vector<BenchRow>& rows, const std::string& name) {
    const auto row = std::ranges::find(rows, name, &BenchRow::name);
    return std::ranges::min(row->samples);
}

}  // namespace

void bench_tree(const std::string& scene_name, const AtomTable& atoms,
                std::vector<BenchRow>& rows) {
    Connectivity connectivity;
    connectivity.file = scene_name;
    connectivity.names = atoms.names;
    connectivity.mass = atoms.mass;
    connectivity.bonds = atoms.bonds;
    JointRules all_rotors;
    all_rotors.methyl = all_rotors.amide_nh2 = all_rotors.guanidinium_nh2 = true;
    TreeBench by_rule = build_tree_bench(connectivity, atoms.positions, {});
    TreeBench with_rotors = build_tree_bench(connectivity, atoms.positions, all_rotors);
    const std::size_t joints = by_rule.tree.bodies.joints();
    const std::size_t more = with_rotors.tree.bodies.joints();
    add_rows(fmt::format("tree/{}/joints={}", scene_name, joints), by_rule, rows);
    if (more > joints) {
        add_rows(fmt::format("tree/{}/joints={}", scene_name, more), with_rotors, rows);
    }
}

void bench_polymers(std::vector<BenchRow>& rows) {
    // Least squares of log time over log joints.
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const std::size_t joints : {100, 1000, 5000, 20000}) {
        std::vector<Vec3> positions;
        const Connectivity polymer = polymer_of(joints, positions);
        TreeBench bench = build_tree_bench(polymer, positions, {});
        const std::string name = fmt::format("tree/polymer/joints={}", joints);
        add_rows(name, bench, rows);
        const double log_joints = std::log(static_cast<double>(joints));
        const double log_time = std::log(least_of(rows, name + "/passes"));
        n += 1;
        x += log_joints;
        y += log_time;
        xx += log_joints * log_joints;
        xy += log_joints * log_time;
    }
    rows.push_back({"tree/polymer/passes/exponent",
                    {(n * xy - x * y) / (n * xx - x * x)},
                    "",
                    {},
                    "",
                    "100 to 20000 joints, least of all runs"});
}

}  // namespace palpa
