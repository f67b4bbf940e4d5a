// Which joints wake: those that would move most, as a connected region from the roots of the tree.
#pragma once
#include "assembly/metric.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpa {

enum class SelectionShape : std::uint8_t {
    // As in the paper: whatever is opened is active, a connected region from the roots of the tree.
    // To wake a joint far down wakes all that part it from the roots, which cut molecules in
    // halves.
    Region,
    // Those alone that count most by themselves. Parts are opened to find them, and stay rigid
    // else.
    Single,
};

// Where to stop: when that many degrees of freedom are chosen, or when the rest is no more than
// that. A joint is one; a base is those that its guide leaves, six if free, all or none of them.
struct SelectionLimits {
    SelectionShape shape = SelectionShape::Region;
    std::size_t degrees_of_freedom = std::numeric_limits<std::size_t>::max();
    double neglected = 0;  // of the metric's sum of squares
    // By which what was chosen the last time counts more, 1 or more, so that joints do not come and
    // go. With 2.25 accelerations may go up and down by 20 %, (1.2 / 0.8)^2, and nothing changes.
    double advantage = 2.25;
};

// What a step costs as it was measured, in microseconds: fixed + each * degrees of freedom.
struct StepCost {
    double fixed_us = 0;
    double each_us = 0;  // above 0
};

// As many as can be active in a step of that length; none where it is too short for any.
std::size_t degrees_of_freedom_within(double time_us, const StepCost& cost) noexcept;

struct JointSelection {
    // One entry per body as AssemblyState::is_active. Bases with nothing left to choose as the
    // state has them.
    std::vector<std::uint8_t> is_active;
    std::size_t degrees_of_freedom = 0;  // chosen
    double total = 0;                    // the metric of everything, were everything active
    double neglected = 0;                // the metric of what is not chosen

    std::vector<std::uint8_t> is_open;  // of each node; those of the last time have the advantage

    // What may be chosen next, a heap by priority: a part to be opened, or a base.
    struct Choice {
        double priority, metric;
        std::uint32_t node;  // no_node for a base
        std::uint32_t molecule;
    };
    std::vector<Choice> choices;

    // A joint or a base that may be active by itself.
    struct Single {
        double priority, metric;  // for a degree of freedom, of all
        std::uint32_t body;
        std::uint32_t freedom;
    };
    std::vector<Single> singles;  // the best joints so far, a heap with the least in front
    std::vector<Single> bases;
    std::vector<std::uint8_t> was_active;
};

JointSelection build_joint_selection(const AssemblyTree& tree);

// Takes the base or opens the part with the largest metric, again and again, roots first: the
// part's joint becomes active and its two parts wait for their turn. A base that no longer fits is
// passed over. What is left in the queue is what is neglected: squares of the accelerations that
// those joints and bases would have were everything active, no bound on an error of shape or force.
//
// Of single joints and bases those that count most for a degree of freedom are active. A part
// counts as much as all its joints, so those that are left in the queue cannot have a larger one.
//
// The state must have been through upward_pass with everything active that may be chosen, and the
// metric must be of that, with the same weights. Writes forces on handles and accelerations of the
// joints it opens.
void select_joints(const AssemblyTree& tree, const AccelerationMetric& metric,
                   const MetricWeights& weights, const SelectionLimits& limits,
                   AssemblyState& state, JointSelection& selection) noexcept;

}  // namespace palpa
