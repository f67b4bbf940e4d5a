#include "assembly/selection.h"

#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

using Choice = JointSelection::Choice;
using Single = JointSelection::Single;

bool is_less(const Choice& a, const Choice& b) {
    if (a.priority != b.priority) return a.priority < b.priority;
    // Of equal ones the earlier node comes first, so that runs repeat.
    return a.node != b.node ? a.node > b.node : a.molecule > b.molecule;
}

bool is_more(const Single& a, const Single& b) {
    return a.priority != b.priority ? a.priority > b.priority : a.body < b.body;
}

// The joints and bases that count most by themselves, found from the roots.
class SingleSelector {
public:
    SingleSelector(const AssemblyTree& tree, const AccelerationMetric& metric,
                   const MetricWeights& weights, const SelectionLimits& limits,
                   AssemblyState& state, JointSelection& selection)
        : tree_(tree),
          metric_(metric),
          weights_(weights),
          limits_(limits),
          state_(state),
          selection_(selection) {}

    void add_molecule(std::uint32_t molecule) {
        update_base(tree_, molecule, state_);
        const std::uint32_t base = tree_.bases[molecule];
        const auto freedom =
            static_cast<std::uint32_t>(degrees_of_freedom(state_.guides[molecule].guide));
        const bool may_move = state_.is_active[base] != 0;
        selection_.is_active[base] = may_move && freedom == 0 ? 1 : 0;
        if (may_move && freedom > 0) {
            selection_.total += metric_.bases[molecule];
            selection_.bases.push_back(single_of(base, freedom, metric_.bases[molecule]));
        }
        add_part(tree_.roots[molecule], molecule, true);
    }

    void choose_all() {
        selection_.neglected = selection_.total;
        while (!selection_.choices.empty() && !is_found()) {
            std::ranges::pop_heap(selection_.choices, is_less);
            const Choice choice = selection_.choices.back();
            selection_.choices.pop_back();
            open(choice);
        }
        std::vector<Single>& singles = selection_.singles;
        singles.insert(singles.end(), selection_.bases.begin(), selection_.bases.end());
        std::ranges::sort(singles, is_more);
        for (const Single& single : singles) {
            if (selection_.degrees_of_freedom + single.freedom > limits_.degrees_of_freedom)
                continue;
            if (limits_.neglected > 0 && selection_.neglected <= limits_.neglected) break;
            selection_.is_active[single.body] = 1;
            selection_.degrees_of_freedom += single.freedom;
            selection_.neglected -= single.metric;
        }
        selection_.neglected = std::max(0.0, selection_.neglected);
    }

private:
    // Whether nothing in the queue can count more than what is kept.
    bool is_found() const {
        if (selection_.singles.size() < limits_.degrees_of_freedom) return false;
        if (selection_.singles.empty()) return true;
        return limits_.advantage * selection_.choices.front().metric <=
               selection_.singles.front().priority;
    }

    void open(const Choice& choice) {
        const AssemblyNode& node = tree_.nodes[choice.node];
        separate(tree_, choice.node, state_);
        const JointInertia& joint = state_.joints[node.part];
        if (joint.D > 0) {
            const double acceleration = state_.joint_acceleration[node.link];
            add_joint(node.link,
                      weight_of_joint(joint, node.link, weights_) * acceleration * acceleration);
        }
        add_part(node.a, choice.molecule, false);
        add_part(node.b, choice.molecule, false);
    }

    void add_part(std::uint32_t node, std::uint32_t molecule, bool is_root) {
        if (tree_.nodes[node].is_leaf()) return;
        const double metric = std::max(0.0, find_metric(tree_, state_, metric_, node));
        if (is_root) selection_.total += metric;
        selection_.choices.push_back({metric, metric, node, molecule});
        std::ranges::push_heap(selection_.choices, is_less);
    }

    Single single_of(std::uint32_t body, std::uint32_t freedom, double metric) const {
        const double advantage = selection_.was_active[body] != 0 ? limits_.advantage : 1;
        return {advantage * metric / freedom, metric, body, freedom};
    }

    void add_joint(std::uint32_t body, double metric) {
        std::vector<Single>& singles = selection_.singles;
        singles.push_back(single_of(body, 1, metric));
        std::ranges::push_heap(singles, is_more);
        if (singles.size() <= limits_.degrees_of_freedom) return;
        std::ranges::pop_heap(singles, is_more);
        singles.pop_back();
    }

    const AssemblyTree& tree_;
    const AccelerationMetric& metric_;
    const MetricWeights& weights_;
    const SelectionLimits& limits_;
    AssemblyState& state_;
    JointSelection& selection_;
};

// One selection, while it is made. Nodes that were open the last time are marked by was_open, those
// that are opened now by opens_now.
class Selector {
public:
    Selector(const AssemblyTree& tree, const AccelerationMetric& metric,
             const SelectionLimits& limits, AssemblyState& state, JointSelection& selection)
        : tree_(tree), metric_(metric), limits_(limits), state_(state), selection_(selection) {}

    void add_molecule(std::uint32_t molecule) {
        update_base(tree_, molecule, state_);
        const std::uint32_t base = tree_.bases[molecule];
        const bool was_chosen = selection_.is_active[base] != 0;
        const bool may_move = state_.is_active[base] != 0;
        const bool is_choice = may_move && base_freedom(molecule) > 0;
        selection_.is_active[base] = may_move && !is_choice ? 1 : 0;
        if (is_choice) add_choice(metric_.bases[molecule], no_node, molecule, was_chosen);
        add_part(tree_.roots[molecule], molecule);
    }

    void choose_all() {
        while (!selection_.choices.empty() &&
               selection_.degrees_of_freedom < limits_.degrees_of_freedom) {
            std::ranges::pop_heap(selection_.choices, is_less);
            const Choice choice = selection_.choices.back();
            selection_.choices.pop_back();
            if (is_worth_it(choice)) {
                take(choice);
            } else {
                passed_over_ += choice.metric;
            }
        }
        // Afresh, where little is left of much that was added and taken away.
        selection_.neglected = passed_over_;
        for (const Choice& choice : selection_.choices) selection_.neglected += choice.metric;
        for (std::uint8_t& marks : selection_.is_open) marks = marks >= opens_now ? was_open : 0;
    }

private:
    static constexpr std::uint8_t was_open = 1, opens_now = 2;

    std::size_t base_freedom(std::uint32_t molecule) const {
        return degrees_of_freedom(state_.guides[molecule].guide);
    }

    std::size_t freedom_of(const Choice& choice) const {
        if (choice.node == no_node) return base_freedom(choice.molecule);
        return state_.joints[tree_.nodes[choice.node].part].D > 0 ? 1 : 0;
    }

    bool is_worth_it(const Choice& choice) const {
        const bool was_chosen = choice.priority > choice.metric;
        const double enough = limits_.neglected / (was_chosen ? limits_.advantage : 1);
        if (limits_.neglected > 0 && selection_.neglected <= enough) return false;
        return selection_.degrees_of_freedom + freedom_of(choice) <= limits_.degrees_of_freedom;
    }

    void take(const Choice& choice) {
        const std::size_t freedom = freedom_of(choice);
        selection_.neglected -= choice.metric;
        selection_.degrees_of_freedom += freedom;
        if (choice.node == no_node) {
            selection_.is_active[tree_.bases[choice.molecule]] = 1;
            return;
        }
        const AssemblyNode& node = tree_.nodes[choice.node];
        separate(tree_, choice.node, state_);
        if (freedom > 0) selection_.is_active[node.link] = 1;
        selection_.is_open[choice.node] |= opens_now;
        add_part(node.a, choice.molecule);
        add_part(node.b, choice.molecule);
    }

    void add_part(std::uint32_t node, std::uint32_t molecule) {
        if (tree_.nodes[node].is_leaf()) return;
        add_choice(find_metric(tree_, state_, metric_, node), node, molecule,
                   (selection_.is_open[node] & was_open) != 0);
    }

    void add_choice(double metric, std::uint32_t node, std::uint32_t molecule, bool was_chosen) {
        // Rounding may leave a part at rest with less than nothing.
        metric = std::max(0.0, metric);
        const double priority = was_chosen ? limits_.advantage * metric : metric;
        selection_.neglected += metric;
        selection_.choices.push_back({priority, metric, node, molecule});
        std::ranges::push_heap(selection_.choices, is_less);
    }

    const AssemblyTree& tree_;
    const AccelerationMetric& metric_;
    const SelectionLimits& limits_;
    AssemblyState& state_;
    JointSelection& selection_;
    double passed_over_ = 0;
};

}  // namespace

std::size_t degrees_of_freedom_within(double time_us, const StepCost& cost) noexcept {
    const double count = std::floor((time_us - cost.fixed_us) / cost.each_us);
    return count > 0 ? static_cast<std::size_t>(std::min(count, 1e9)) : 0;
}

JointSelection build_joint_selection(const AssemblyTree& tree) {
    JointSelection selection;
    selection.is_active.assign(tree.bodies.bodies.size(), 0);
    selection.is_open.assign(tree.nodes.size(), 0);
    selection.choices.reserve(tree.nodes.size() + tree.bases.size());
    return selection;
}

void select_joints(const AssemblyTree& tree, const AccelerationMetric& metric,
                   const MetricWeights& weights, const SelectionLimits& limits,
                   AssemblyState& state, JointSelection& selection) noexcept {
    selection.choices.clear();
    selection.singles.clear();
    selection.bases.clear();
    selection.was_active = selection.is_active;
    selection.degrees_of_freedom = 0;
    selection.neglected = 0;
    selection.total = 0;
    for (std::size_t b = 0; b < selection.is_active.size(); ++b) {
        if (!tree.bodies.is_base(b)) selection.is_active[b] = 0;
    }
    if (limits.shape == SelectionShape::Single) {
        SingleSelector selector(tree, metric, weights, limits, state, selection);
        for (std::uint32_t i = 0; i < tree.roots.size(); ++i) selector.add_molecule(i);
        selector.choose_all();
        return;
    }
    Selector selector(tree, metric, limits, state, selection);
    for (std::uint32_t i = 0; i < tree.roots.size(); ++i) selector.add_molecule(i);
    selection.total = selection.neglected;
    selector.choose_all();
}

}  // namespace palpa
