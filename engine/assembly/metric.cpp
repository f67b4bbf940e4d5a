#include "assembly/metric.h"

#include "assembly/parts.h"

#include <algorithm>
#include <array>

namespace palpa {
namespace {

double factor_of(const MetricWeights& weights, std::uint32_t body) {
    return weights.factors.empty() ? 1 : weights.factors[body];
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
void join_metric(const AssemblyTree& tree, const AssemblyNode& node, const AssemblyState& state,
                 const MetricWeights& weights, AccelerationMetric& metric) {
    const JointInertia& joint = state.joints[node.part];
    const std::array sides = sides_of(tree, node);
    const std::array<PartInertia, 2> parts{PartInertia(tree, state, *sides[0].node),
                                           PartInertia(tree, state, *sides[1].node)};
    const Vec6 beta = parts[0].b(sides[0].joined()) - parts[1].b(sides[1].joined());
    // Of a side that is no leaf.
    const auto psi_of = [&](const Side& side, std::uint32_t i, std::uint32_t j) -> const Mat6& {
        return metric.psi[side.node->first_pair + pair_number(i, j)];
    };
    const auto p_of = [&](const Side& side, std::uint32_t i) -> const Vec6& {
        return metric.p[side.node->first_handle + i];
    };

    FormOfJoint form;
    form.K = weight_of_joint(joint, node.link, weights) * joint.gain * joint.gain.transpose();
    form.r.setZero();
    double eta = 0;
    for (const Side& side : sides) {
        if (side.node->is_leaf()) continue;
        const Mat6 psi_W = psi_of(side, side.joined(), side.joined()).lazyProduct(joint.W);
        form.K += joint.W.lazyProduct(psi_W);
        form.r -= side.sign * (joint.W * p_of(side, side.joined()));
        eta += metric.eta[side.node->part];
    }
    metric.eta[node.part] = eta + beta.dot(form.K * beta) + form.r.dot(beta);

    std::array<Mat6, 3> M, N;
    for (std::uint32_t j = 0; j < node.handles; ++j) {
        const Side& side_j = sides[node.side[j]];
        const std::uint32_t j_there = node.number[j];
        const Mat6& L_j = parts[node.side[j]].phi(j_there, side_j.joined());
        Vec6& p = metric.p[node.first_handle + j];
        N[j].setZero();
        p.setZero();
        if (!side_j.node->is_leaf()) {
            N[j] = psi_of(side_j, j_there, side_j.joined()).lazyProduct(joint.W);
            p = p_of(side_j, j_there);
        }
        M[j] = L_j.lazyProduct(form.K) - N[j];
        p += side_j.sign * (2 * M[j] * beta + L_j * form.r);
        for (std::uint32_t i = 0; i <= j; ++i) {
            const Side& side_i = sides[node.side[i]];
            const std::uint32_t i_there = node.number[i];
            const Mat6& L_i = parts[node.side[i]].phi(i_there, side_i.joined());
            Mat6& psi = metric.psi[node.first_pair + pair_number(i, j)];
            psi = M[i].lazyProduct(L_j.transpose());
            psi -= L_i.lazyProduct(N[j].transpose());
            if (node.side[i] != node.side[j]) {
                psi = -psi;
            } else if (!side_i.node->is_leaf()) {
                psi += psi_of(side_i, i_there, j_there);
            }
        }
    }
}

// The components that the guide prescribes have nothing to do with what the base is worth.
double base_metric(const AssemblyTree& tree, const AssemblyState& state, std::size_t molecule,
                   const MetricWeights& weights) {
    const BaseGuide guide = state.guides[molecule].guide;
    const std::uint32_t base = tree.bases[molecule];
    if (state.is_active[base] == 0 || guide == BaseGuide::Whole) return 0;
    const AssemblyNode& root = tree.nodes[tree.roots[molecule]];
    const PartInertia part(tree, state, root);
    Vec6 a = find_base_motion(tree, state, molecule, part).acceleration;
    if (guide == BaseGuide::Point) {
        // About the point at which it is guided, which does not count, the base only turns.
        const Vec3 arm = arm_of_guide(tree, state, molecule), turn = a.head<3>();
        a << turn, -turn.cross(arm);
    }
    const double factor = factor_of(weights, base);
    if (weights.weight == MetricWeight::Inertia) {
        return factor * a.dot(push_for(tree, molecule, part.phi(0, 0), a));
    }
    if (guide == BaseGuide::Point) return factor * a.head<3>().squaredNorm();
    const double radius = std::max(state.gyration[molecule], 1.0);
    return factor * (a.head<3>().squaredNorm() + a.tail<3>().squaredNorm() / (radius * radius));
}

}  // namespace

double weight_of_joint(const JointInertia& joint, std::uint32_t link,
                       const MetricWeights& weights) noexcept {
    if (!(joint.D > 0)) return 0;
    const double inertia = weights.weight == MetricWeight::Inertia ? 1 / joint.D : 1;
    return inertia * factor_of(weights, link);
}

AccelerationMetric build_acceleration_metric(const AssemblyTree& tree) {
    AccelerationMetric metric;
    metric.psi.assign(tree.pairs, Mat6::Zero());
    metric.p.assign(tree.handles, Vec6::Zero());
    metric.eta.assign(tree.parts, 0);
    metric.bases.assign(tree.bases.size(), 0);
    return metric;
}

void update_metric(const AssemblyTree& tree, const AssemblyState& state,
                   const MetricWeights& weights, AccelerationMetric& metric) noexcept {
    for (const AssemblyNode& node : tree.nodes) {
        if (!node.is_leaf()) join_metric(tree, node, state, weights, metric);
    }
    for (std::size_t i = 0; i < tree.bases.size(); ++i) {
        metric.bases[i] = base_metric(tree, state, i, weights);
    }
}

double find_metric(const AssemblyTree& tree, const AssemblyState& state,
                   const AccelerationMetric& metric, std::uint32_t node) noexcept {
    const AssemblyNode& part = tree.nodes[node];
    if (part.is_leaf()) return 0;
    double sum = metric.eta[part.part];
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
