#include "assembly/metric.h"

#include "assembly/parts.h"

#include <algorithm>
#include <array>

namespace palpa {
namespace {

double factor_of(const MetricWeights& weights, std::uint32_t body) {
    return weights.factors.empty() ? 1 : weights.factors[body];
}

// Two parts and what they are joined to. Both parts' forms at their joined handles, +-W u, and the
// joint's own square, are a form u^T K u + r^T u of
//     u = sum_j s_j L_j^T f_j + beta,   s = 1 in A and -1 in B, L_j = phi of handle and joined one,
// as passes.cpp has it.
struct Joined {
    const AssemblyNode& node;
    std::array<Side, 2> sides;
    std::array<PartInertia, 2> parts;
    Vec6 beta;

    Joined(const AssemblyTree& tree, const AssemblyState& state, const AssemblyNode& joined)
        : node(joined),
          sides(sides_of(tree, joined)),
          parts{PartInertia(tree, state, *sides[0].node), PartInertia(tree, state, *sides[1].node)},
          beta(parts[0].b(sides[0].joined()) - parts[1].b(sides[1].joined())) {}

    const Mat6& phi_to_joint(std::uint32_t handle) const {
        const std::uint32_t side = node.side[handle];
        return parts[side].phi(node.number[handle], sides[side].joined());
    }
};

const Mat6& psi_of(const AccelerationMetric& metric, const AssemblyNode& part, std::uint32_t i,
                   std::uint32_t j) {
    return metric.psi[part.first_pair + pair_number(i, j)];
}

// With N_i = psi_i,joined W the form of the joined part is the sum of those of u, of the handles
// themselves, and of what ties them: -2 s_i f_i^T N_i u. Collecting what stands before f and f^T f:
//     M_i    = L_i K - N_i
//     psi_ij = [psi_ij of the side, if i and j are on one] + s_i s_j (M_i L_j^T - L_i N_j^T)
//     p_i    = p_i of the side + s_i (2 M_i beta + L_i r)
//     eta    = eta_A + eta_B + beta^T K beta + r^T beta
// First psi, which forces have no part in.
void join_psi(const Joined& joined, const JointInertia& joint, double weight,
              AccelerationMetric& metric) {
    const auto& [node, sides, parts, beta] = joined;
    Mat6 K = weight * joint.gain * joint.gain.transpose();
    for (const Side& side : sides) {
        if (side.node->is_leaf()) continue;
        const Mat6 psi_W =
            psi_of(metric, *side.node, side.joined(), side.joined()).lazyProduct(joint.W);
        K += joint.W.lazyProduct(psi_W);
    }

    std::array<Mat6, 3> M, N;
    for (std::uint32_t j = 0; j < node.handles; ++j) {
        const Side& side_j = sides[node.side[j]];
        const Mat6& L_j = joined.phi_to_joint(j);
        N[j].setZero();
        if (!side_j.node->is_leaf()) {
            N[j] =
                psi_of(metric, *side_j.node, node.number[j], side_j.joined()).lazyProduct(joint.W);
        }
        M[j] = L_j.lazyProduct(K) - N[j];
        for (std::uint32_t i = 0; i <= j; ++i) {
            const Side& side_i = sides[node.side[i]];
            Mat6& psi = metric.psi[node.first_pair + pair_number(i, j)];
            psi = M[i].lazyProduct(L_j.transpose());
            psi -= joined.phi_to_joint(i).lazyProduct(N[j].transpose());
            if (node.side[i] != node.side[j]) {
                psi = -psi;
            } else if (!side_i.node->is_leaf()) {
                psi += psi_of(metric, *side_i.node, node.number[i], node.number[j]);
            }
        }
    }
}

// Then what forces have to do with: p and eta, without products of matrices.
void join_bias(const Joined& joined, const JointInertia& joint, double weight,
               AccelerationMetric& metric) {
    const auto& [node, sides, parts, beta] = joined;
    const Vec6 W_beta = joint.W * beta;
    Vec6 K_beta = weight * joint.gain.dot(beta) * joint.gain, r = Vec6::Zero();
    double eta = 0;
    for (const Side& side : sides) {
        if (side.node->is_leaf()) continue;
        const Mat6& psi = psi_of(metric, *side.node, side.joined(), side.joined());
        const Vec6& p = metric.p[side.node->first_handle + side.joined()];
        K_beta += joint.W * (psi * W_beta);
        r -= side.sign * (joint.W * p);
        eta += metric.eta[side.node->part];
    }
    metric.eta[node.part] = eta + beta.dot(K_beta + r);

    for (std::uint32_t j = 0; j < node.handles; ++j) {
        const Side& side = sides[node.side[j]];
        Vec6& p = metric.p[node.first_handle + j];
        p = side.sign * (joined.phi_to_joint(j) * (2 * K_beta + r));
        if (side.node->is_leaf()) continue;
        const Mat6& psi = psi_of(metric, *side.node, node.number[j], side.joined());
        p += metric.p[side.node->first_handle + node.number[j]] - 2 * side.sign * (psi * W_beta);
    }
}

// Whether forms are of these weights; they are from now on.
bool take_weights(const MetricWeights& weights, AccelerationMetric& metric) {
    const bool are_same =
        metric.weight == weights.weight && std::ranges::equal(metric.factors, weights.factors);
    metric.weight = weights.weight;
    metric.factors.assign(weights.factors.begin(), weights.factors.end());
    return are_same;
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
                   const MetricWeights& weights, AccelerationMetric& metric) {
    const bool is_new = !take_weights(weights, metric);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const AssemblyNode& node = tree.nodes[i];
        const Change change = is_new ? Change::Places : state.changes[i];
        if (node.is_leaf() || change == Change::None) continue;
        const JointInertia& joint = state.joints[node.part];
        const double weight = weight_of_joint(joint, node.link, weights);
        const Joined joined(tree, state, node);
        if (change == Change::Places) join_psi(joined, joint, weight, metric);
        join_bias(joined, joint, weight, metric);
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
