// How much the joints below each node of an assembly tree accelerate, known before any of them is.
#pragma once
#include "assembly/passes.h"

#include <cstdint>
#include <vector>

namespace palpa {

// What the square of a joint's acceleration counts.
enum class MetricWeight : std::uint8_t {
    Plain,    // 1, as in the paper
    Inertia,  // the inertia that a torque on the joint meets with all others open, amu Å^2
};

// The weighted sum of squared joint accelerations in a part is a quadratic form of the forces on
// its handles: sum_ij f_i^T psi_ij f_j + sum_i p_i^T f_i + eta (S. Redon et al., ACM Trans. Graph.
// 24, 936 (2005)). Laid out as in AssemblyState, for joined parts; of leaves all is 0.
struct AccelerationMetric {
    std::vector<Mat6> psi;    // of pairs of handles
    std::vector<Vec6> p;      // of handles
    std::vector<double> eta;  // of parts
};

AccelerationMetric build_acceleration_metric(const AssemblyTree& tree);

// From the leaves to the roots, after upward_pass. Joints that are not active count nothing.
void update_metric(const AssemblyTree& tree, const AssemblyState& state, MetricWeight weight,
                   AccelerationMetric& metric) noexcept;

// Of one part, from the forces on its handles that the state holds.
double find_metric(const AssemblyTree& tree, const AssemblyState& state,
                   const AccelerationMetric& metric, std::uint32_t node) noexcept;

}  // namespace palpa
