// Which joints wake: those that would move most, as a connected region from the roots of the tree.
#pragma once
#include "assembly/metric.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpa {

// Where to stop: when that many joints are chosen, or when what is left is no more than that.
struct SelectionLimits {
    std::size_t joints = std::numeric_limits<std::size_t>::max();
    double neglected = 0;  // of the metric's sum of squares
};

struct JointSelection {
    // One entry per body as AssemblyState::is_active; bases as the state has them.
    std::vector<std::uint8_t> is_active;
    std::size_t joints = 0;  // chosen
    double total = 0;        // the metric of everything, were every joint active
    double neglected = 0;    // the metric of what is not chosen

    // The parts that may be opened next, a heap by metric.
    struct Part {
        double metric;
        std::uint32_t node;
    };
    std::vector<Part> parts;
};

JointSelection build_joint_selection(const AssemblyTree& tree);

// Opens the part with the largest metric, again and again, roots first: its joint becomes active
// and its two parts wait for their turn. What is left in the queue is what is neglected: squares of
// the accelerations that those joints would have, no bound on an error of shape or force.
//
// The state must have been through upward_pass with all joints active that may be chosen, and the
// metric must be of that. Writes forces on handles and accelerations of the joints it opens.
void select_joints(const AssemblyTree& tree, const AccelerationMetric& metric,
                   const SelectionLimits& limits, AssemblyState& state,
                   JointSelection& selection) noexcept;

}  // namespace palpa
