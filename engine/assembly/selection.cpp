#include "assembly/selection.h"

#include <algorithm>

namespace palpa {
namespace {

bool is_less(const JointSelection::Part& a, const JointSelection::Part& b) {
    // Of equal ones the earlier node comes first, so that runs repeat.
    return a.metric != b.metric ? a.metric < b.metric : a.node > b.node;
}

void add_part(const AssemblyTree& tree, const AssemblyState& state,
              const AccelerationMetric& metric, std::uint32_t node, JointSelection& selection) {
    if (tree.nodes[node].is_leaf()) return;
    // Rounding may leave a part at rest with less than nothing.
    const double sum = std::max(0.0, find_metric(tree, state, metric, node));
    selection.parts.push_back({sum, node});
    std::ranges::push_heap(selection.parts, is_less);
    selection.neglected += sum;
}

// Afresh, where little is left of much that was added and taken away.
double sum_of_parts(const JointSelection& selection) {
    double sum = 0;
    for (const JointSelection::Part& part : selection.parts) sum += part.metric;
    return sum;
}

}  // namespace

JointSelection build_joint_selection(const AssemblyTree& tree) {
    JointSelection selection;
    selection.is_active.assign(tree.bodies.bodies.size(), 0);
    selection.parts.reserve(tree.nodes.size());
    return selection;
}

void select_joints(const AssemblyTree& tree, const AccelerationMetric& metric,
                   const SelectionLimits& limits, AssemblyState& state,
                   JointSelection& selection) noexcept {
    selection.parts.clear();
    selection.joints = 0;
    selection.neglected = 0;
    std::ranges::fill(selection.is_active, 0);
    for (std::size_t molecule = 0; molecule < tree.roots.size(); ++molecule) {
        update_base(tree, molecule, state);
        selection.is_active[tree.bases[molecule]] = state.is_active[tree.bases[molecule]];
        add_part(tree, state, metric, tree.roots[molecule], selection);
    }
    selection.total = selection.neglected;
    while (!selection.parts.empty() && selection.joints < limits.joints &&
           selection.neglected > limits.neglected) {
        const auto [sum, number] = selection.parts.front();
        const AssemblyNode& node = tree.nodes[number];
        std::ranges::pop_heap(selection.parts, is_less);
        selection.parts.pop_back();
        selection.neglected -= sum;
        separate(tree, number, state);
        if (state.joints[node.part].D > 0) {
            selection.is_active[node.link] = 1;
            ++selection.joints;
        }
        add_part(tree, state, metric, node.a, selection);
        add_part(tree, state, metric, node.b, selection);
    }
    selection.neglected = sum_of_parts(selection);
}

}  // namespace palpa
