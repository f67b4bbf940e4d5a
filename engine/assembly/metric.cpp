#include "assembly/metric.h"

#include "assembly/sides.h"

#include <array>

namespace palpa {
namespace {

double weight_of(const JointInertia& joint, MetricWeight weight) {
    return weight == MetricWeight::Inertia && joint.D > 0 ? 1 / joint.D : 1;
}

// Both parts' forms at their joined handles, +-W u, and the joint's own square, as forms of
//     u = sum_j s_j L_j^T f_j + beta,   s = 1 in A and -1 in B, L_j = phi of handle and joined one,
// as passes.cpp has it: u^T K u + r^T u.
struct FormOfJoint {
    Mat6 K;
    Vec6 r;
};

// With N_i = psi_i,joined W the form of the joined part is the sum of those of u, of the handles
// themselves, and of what ties them: -2 s_i f_i^T N_i u. Collecting what stands before f and f^T f:
//     M_i    = L_i K - N_i
//     psi_ij = [psi_ij of the side, if i and j are on one] + s_i s_j (M_i L_j^T - L_i N_j^T)
//     p_i    = p_i of the side + s_i (2 M_i beta + L_i r)
//     eta    = eta_A + eta_B + beta^T K beta + r^T beta
void join_metric(const AssemblyTree& tree, std::size_t number, const AssemblyState& state,
                 MetricWeight weight, AccelerationMetric& metric) {
    const AssemblyNode& node = tree.nodes[number];
    const JointInertia& joint = state.joints[number];
    const std::array sides = sides_of(tree, node);
    const Vec6 beta = state.b[sides[0].joined_handle()] - state.b[sides[1].joined_handle()];

    FormOfJoint form;
    form.K = weight_of(joint, weight) * joint.gain * joint.gain.transpose();
    form.r.setZero();
    for (const Side& side : sides) {
        if (side.node->is_leaf()) continue;
        const Mat6 psi_W = metric.psi[side.pair(side.joined(), side.joined())].lazyProduct(joint.W);
        form.K += joint.W.lazyProduct(psi_W);
        form.r -= side.sign * (joint.W * metric.p[side.joined_handle()]);
    }
    metric.eta[number] =
        metric.eta[node.a] + metric.eta[node.b] + beta.dot(form.K * beta) + form.r.dot(beta);

    std::array<Mat6, 3> M, N;
    for (std::uint32_t j = 0; j < node.handles; ++j) {
        const Side& side_j = sides[node.side[j]];
        const std::uint32_t j_there = node.number[j];
        const Mat6& L_j = state.phi[side_j.pair(j_there, side_j.joined())];
        N[j].setZero();
        if (!side_j.node->is_leaf()) {
            N[j] = metric.psi[side_j.pair(j_there, side_j.joined())].lazyProduct(joint.W);
        }
        M[j] = L_j.lazyProduct(form.K) - N[j];
        metric.p[node.first_handle + j] =
            metric.p[side_j.handle(j_there)] + side_j.sign * (2 * M[j] * beta + L_j * form.r);
        for (std::uint32_t i = 0; i <= j; ++i) {
            const Side& side_i = sides[node.side[i]];
            const std::uint32_t i_there = node.number[i];
            const Mat6& L_i = state.phi[side_i.pair(i_there, side_i.joined())];
            Mat6& psi = metric.psi[node.first_pair + pair_number(i, j)];
            psi = M[i].lazyProduct(L_j.transpose());
            psi -= L_i.lazyProduct(N[j].transpose());
            if (node.side[i] == node.side[j]) {
                psi += metric.psi[side_i.pair(i_there, j_there)];
            } else {
                psi = -psi;
            }
        }
    }
}

}  // namespace

AccelerationMetric build_acceleration_metric(const AssemblyTree& tree) {
    AccelerationMetric metric;
    metric.psi.assign(tree.pairs, Mat6::Zero());
    metric.p.assign(tree.handles, Vec6::Zero());
    metric.eta.assign(tree.nodes.size(), 0);
    return metric;
}

void update_metric(const AssemblyTree& tree, const AssemblyState& state, MetricWeight weight,
                   AccelerationMetric& metric) noexcept {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        if (!tree.nodes[i].is_leaf()) join_metric(tree, i, state, weight, metric);
    }
}

double find_metric(const AssemblyTree& tree, const AssemblyState& state,
                   const AccelerationMetric& metric, std::uint32_t node) noexcept {
    const AssemblyNode& part = tree.nodes[node];
    double sum = metric.eta[node];
    for (std::uint32_t j = 0; j < part.handles; ++j) {
        const Vec6& f_j = state.f[part.first_handle + j];
        sum += metric.p[part.first_handle + j].dot(f_j);
        for (std::uint32_t i = 0; i <= j; ++i) {
            const Vec6& f_i = state.f[part.first_handle + i];
            const double product = f_i.dot(metric.psi[part.first_pair + pair_number(i, j)] * f_j);
            sum += i == j ? product : 2 * product;
        }
    }
    return sum;
}

}  // namespace palpa
