// The acceleration metric: how much the joints below each node of an assembly tree accelerate,
// known before single accelerations are computed.
#pragma once
#include "assembly/passes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// The weight of the squared acceleration of a joint and of a base.
enum class MetricWeight : std::uint8_t {
    // 1, as in the paper. Of a base angular components count 1 and linear ones 1 / radius of
    // gyration squared (of a molecule, at least 1 Å).
    Plain,
    // The inertia that a torque on the joint meets in the two parts that it joins, by themselves
    // and with their joints open, amu Å^2: large parts count more than small ones, whose cuts
    // follow from the tree. Of a base a^T I a with the inertia I that a push on it meets.
    Inertia,
};

struct MetricWeights {
    MetricWeight weight = MetricWeight::Plain;
    // By which each body's joint or base counts more or less besides, 0 or more; none for all 1.
    // With large ones for what is near to the hand, joints there wake first.
    std::span<const double> factors;
};

// The weighted sum of squared joint accelerations in a part is a quadratic form of the forces on
// its handles: sum_ij f_i^T psi_ij f_j + sum_i p_i^T f_i + eta (S. Redon et al., ACM Trans. Graph.
// 24, 936 (2005)). Laid out as in AssemblyState, for joined parts; of leaves all is 0.
struct AccelerationMetric {
    std::vector<Mat6> psi;    // for pairs of handles
    std::vector<Vec6> p;      // for each handle
    std::vector<double> eta;  // for each part
    // Of each molecule: the weighted square of its base's acceleration with everything active, of
    // the components that its guide leaves. 0 if none is left.
    std::vector<double> bases;
    // What it was last of; without joints' factors that is all 1.
    MetricWeight weight = MetricWeight::Plain;
    std::vector<double> factors;
};

AccelerationMetric build_acceleration_metric(const AssemblyTree& tree);

// From the leaves to the roots, after upward_pass. What is not active counts nothing. Of parts that
// the state does not mark as changed all stays, unless weights are others.
void update_metric(const AssemblyTree& tree, const AssemblyState& state,
                   const MetricWeights& weights, AccelerationMetric& metric);

// The weight of a joint's squared acceleration; 0 for a rigid joint.
double weight_of_joint(const JointInertia& joint, std::uint32_t link,
                       const MetricWeights& weights) noexcept;

// The metric of the joints in one part, from the forces on its handles in the state.
double find_metric(const AssemblyTree& tree, const AssemblyState& state,
                   const AccelerationMetric& metric, std::uint32_t node) noexcept;

}  // namespace palpa
