// Selects the active joints: those that would accelerate most.
#pragma once
#include "assembly/metric.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpa {

enum class SelectionShape : std::uint8_t {
    // As in the paper: opened parts are active, a connected region from the roots of the tree. To
    // activate a joint deep in the tree, all joints above it are activated, which cut molecules in
    // halves.
    Region,
    // Only the single joints with the largest weight. Parts are opened to find them, but stay rigid
    // otherwise.
    Single,
};

// When to stop: at this number of degrees of freedom, or when the neglected metric is at most this.
// A joint counts 1; a base counts what its guide leaves (6 if free), all or none.
struct SelectionLimits {
    SelectionShape shape = SelectionShape::Region;
    std::size_t degrees_of_freedom = std::numeric_limits<std::size_t>::max();
    double neglected = 0;  // largest neglected sum of squares
    // By which what was chosen the last time counts more, 1 or more, so that joints do not come and
    // go. With 2.25 accelerations may go up and down by 20 %, (1.2 / 0.8)^2, and nothing changes.
    double advantage = 2.25;
};

// The measured time of a step, µs: fixed + each * degrees of freedom.
struct StepCost {
    double fixed_us = 0;
    double each_us = 0;  // above 0
};

// The number that can be active in a step of this length; 0 if it is too short for any.
std::size_t degrees_of_freedom_within(double time_us, const StepCost& cost) noexcept;

struct JointSelection {
    // One entry per body as AssemblyState::is_active. Bases with nothing left to choose as the
    // state has them.
    std::vector<std::uint8_t> is_active;
    std::size_t degrees_of_freedom = 0;  // selected
    double total = 0;                    // metric with everything active
    double neglected = 0;                // metric of what is not selected

    std::vector<std::uint8_t>
        is_open;  // opened nodes; those of the last selection have the advantage

    // A candidate, in a heap by priority: a part to open, or a base.
    struct Choice {
        double priority, metric;
        std::uint32_t node;  // no_node for a base
        std::uint32_t molecule;
    };
    std::vector<Choice> choices;

    // A joint or a base that may be active by itself.
    struct Single {
        double priority, metric;  // per degree of freedom; in all
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
