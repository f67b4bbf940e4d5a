#include "assembly/hybrid.h"

#include "assembly/parts.h"
#include "core/assertion.h"

namespace palpa {
namespace {

// Bodies, parents before children, joined to the cluster of their parent where their joint rests.
TorsionBodies build_cluster_bodies(const AssemblyTree& whole,
                                   std::span<const std::uint8_t> is_active, HybridTree& hybrid) {
    const TorsionBodies& bodies = whole.bodies;
    TorsionBodies result;
    result.springs = bodies.springs;
    for (std::uint32_t b = 0; b < bodies.bodies.size(); ++b) {
        Body body = bodies.bodies[b];
        if (!bodies.is_base(b)) {
            const std::uint32_t parent = hybrid.cluster_of[body.parent];
            if (is_active[b] == 0) {
                hybrid.cluster_of.push_back(parent);
                continue;
            }
            body.parent = parent;
        }
        hybrid.cluster_of.push_back(static_cast<std::uint32_t>(result.bodies.size()));
        hybrid.body_of.push_back(b);
        result.bodies.push_back(body);
    }
    for (const std::uint32_t body : bodies.body_of) {
        result.body_of.push_back(hybrid.cluster_of[body]);
    }
    return result;
}

std::vector<double> masses_of(const AssemblyTree& tree) {
    std::vector<double> masses(tree.atoms.size(), 0);
    for (const AtomShare& share : tree.shares) masses[share.atom] += share.mass;
    return masses;
}

}  // namespace

HybridTree build_hybrid_tree(const AssemblyTree& whole, std::span<const std::uint8_t> is_active,
                             std::span<const Vec3> positions) {
    PALPA_ASSERT(is_active.size() == whole.bodies.bodies.size());
    HybridTree hybrid;
    const TorsionBodies bodies = build_cluster_bodies(whole, is_active, hybrid);
    hybrid.tree = build_assembly_tree(bodies, masses_of(whole), positions);
    for (std::uint32_t c = 0; c < bodies.bodies.size(); ++c) {
        BodyState body{};
        update_inertia(hybrid.tree, c, positions, body);
        Cluster cluster{body.mass, body.inverse_inertia, body.spread, Vec3::Zero(), Vec3::Zero()};
        if (!bodies.is_base(c)) {
            const auto [j, k] = bodies.bodies[c].axis;
            cluster.joint_point = positions[k] - body.centre;
            cluster.joint_axis = (positions[k] - positions[j]).normalized();
        }
        for (std::uint32_t i = hybrid.tree.first_atom[c]; i < hybrid.tree.first_atom[c + 1]; ++i) {
            hybrid.places.emplace_back(positions[hybrid.tree.atoms[i]] - body.centre);
        }
        hybrid.clusters.push_back(cluster);
        hybrid.centres.push_back(body.centre);
    }
    return hybrid;
}

HybridState build_hybrid_state(const HybridTree& hybrid, std::span<const std::uint8_t> is_active,
                               std::span<const GuidedBase> guides) {
    const std::size_t clusters = hybrid.clusters.size();
    HybridState state{build_assembly_state(hybrid.tree), {}, hybrid.centres, {}};
    state.passes.guides.assign(guides.begin(), guides.end());
    for (const std::uint32_t base : hybrid.tree.bases) {
        state.passes.is_active[base] = is_active[hybrid.body_of[base]];
    }
    state.orientations.assign(clusters, Eigen::Quaterniond::Identity());
    state.motions.assign(clusters, {Mat3::Identity(), Vec3::Zero()});
    for (BodyState& body : state.passes.bodies) {
        body.force.setZero();
        body.torque.setZero();
    }
    update_clusters(hybrid, state);
    return state;
}

void update_wrenches(const HybridTree& hybrid, std::span<const Vec3> positions,
                     std::span<const Vec3> forces, HybridState& state) noexcept {
    for (std::uint32_t c = 0; c < hybrid.clusters.size(); ++c) {
        BodyState& body = state.passes.bodies[c];
        body.centre = state.centres[c];
        update_wrench(hybrid.tree, c, positions, forces, body);
    }
}

void update_clusters(const HybridTree& hybrid, HybridState& state) noexcept {
    AssemblyState& passes = state.passes;
    for (std::size_t c = 0; c < hybrid.clusters.size(); ++c) {
        const Cluster& cluster = hybrid.clusters[c];
        const Mat3 turn = state.orientations[c].toRotationMatrix();
        BodyState& body = passes.bodies[c];
        body.mass = cluster.mass;
        body.spread = cluster.spread;
        body.centre = state.centres[c];
        body.inverse_inertia = turn * cluster.inverse_inertia * turn.transpose();
        if (hybrid.tree.bodies.is_base(c)) continue;
        passes.points[c] = body.centre + turn * cluster.joint_point;
        passes.axes[c] = turn * cluster.joint_axis;
    }
    update_links(hybrid.tree, passes);
}

void update_accelerations(const HybridTree& hybrid, HybridState& state) noexcept {
    update_clusters(hybrid, state);
    upward_pass(hybrid.tree, state.passes);
    downward_pass(hybrid.tree, state.passes);
}

void move_clusters(const HybridTree& hybrid, std::span<const double> joint_turns,
                   std::span<const Vec6> base_moves, HybridState& state) noexcept {
    AssemblyState& passes = state.passes;
    for (std::uint32_t c = 0; c < hybrid.clusters.size(); ++c) {
        RigidMotion& motion = state.motions[c];
        if (hybrid.tree.bodies.is_base(c)) {
            const std::uint32_t molecule = hybrid.tree.molecule_of[c];
            const Vec6& move = base_moves[molecule];
            const Vec3 turn = move.head<3>(), &ground = passes.points[c];
            motion.rotation = turn_of(turn).toRotationMatrix();
            motion.translation = ground - motion.rotation * ground + move.tail<3>();
            std::optional<Vec3>& guided = passes.guides[molecule].point;
            if (guided) guided = motion.rotation * *guided + motion.translation;
        } else {
            // First about the axis where it was, then with the parent.
            const RigidMotion& parent = state.motions[hybrid.tree.bodies.bodies[c].parent];
            const Mat3 turn = turn_by(joint_turns[c], passes.axes[c]).toRotationMatrix();
            const Vec3 shift = passes.points[c] - turn * passes.points[c];
            motion.rotation = parent.rotation * turn;
            motion.translation = parent.rotation * shift + parent.translation;
        }
        state.centres[c] = motion.rotation * state.centres[c] + motion.translation;
        state.orientations[c] = Eigen::Quaterniond(motion.rotation) * state.orientations[c];
        state.orientations[c].normalize();
    }
}

std::span<const std::uint32_t> atoms_of(const HybridTree& hybrid, std::size_t cluster) noexcept {
    const std::uint32_t first = hybrid.tree.first_atom[cluster];
    return std::span(hybrid.tree.atoms).subspan(first, hybrid.tree.first_atom[cluster + 1] - first);
}

void update_positions(const HybridTree& hybrid, const HybridState& state, std::uint32_t cluster,
                      std::span<Vec3> positions) noexcept {
    const Mat3 turn = state.orientations[cluster].toRotationMatrix();
    const std::span<const std::uint32_t> first = hybrid.tree.first_atom;
    for (std::uint32_t i = first[cluster]; i < first[cluster + 1]; ++i) {
        positions[hybrid.tree.atoms[i]] = state.centres[cluster] + turn * hybrid.places[i];
    }
}

void update_positions(const HybridTree& hybrid, const HybridState& state,
                      std::span<Vec3> positions) noexcept {
    for (std::uint32_t c = 0; c < hybrid.clusters.size(); ++c) {
        update_positions(hybrid, state, c, positions);
    }
}

}  // namespace palpa
