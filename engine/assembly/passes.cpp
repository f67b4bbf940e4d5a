#include "assembly/passes.h"

#include "assembly/parts.h"
#include "core/assertion.h"
#include "math/eigenvectors.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

// Without the direction in which nothing has inertia: no torque of the atoms' forces has it either.
Mat3 pseudo_inverse(const Mat3& inertia) {
    const auto [moments, axes] = find_eigenvectors(inertia);
    Mat3 result = Mat3::Zero();
    for (int i = 0; i < 3; ++i) {
        const Vec3 axis = axes.col(i);
        if (moments[i] > 1e-6 * moments[2]) result += axis * axis.transpose() / moments[i];
    }
    return result;
}

// phi_ij of a rigid body: a force F and a torque n at r_j from its centre turn it by
// alpha = I^-1 (n + r_j x F), and the point at r_i has the acceleration F / m + alpha x r_i.
Mat6 rigid_phi(const BodyState& body, const Vec3& r_i, const Vec3& r_j) {
    const Mat3 turn = body.inverse_inertia * cross_matrix(r_j);
    Mat6 phi;
    phi.topLeftCorner<3, 3>() = body.inverse_inertia;
    phi.topRightCorner<3, 3>() = turn;
    phi.bottomLeftCorner<3, 3>() = -cross_matrix(r_i) * body.inverse_inertia;
    phi.bottomRightCorner<3, 3>() = 1 / body.mass * Mat3::Identity() - cross_matrix(r_i) * turn;
    return phi;
}

// The centres of mass of the molecules, and how far their mass is from there.
void place_grounds(const AssemblyTree& tree, AssemblyState& state) {
    for (const std::uint32_t base : tree.bases) state.points[base].setZero();
    std::ranges::fill(state.molecule_mass, 0);
    std::ranges::fill(state.gyration, 0);
    for (std::size_t b = 0; b < state.bodies.size(); ++b) {
        const std::uint32_t molecule = tree.molecule_of[b];
        state.points[tree.bases[molecule]] += state.bodies[b].mass * state.bodies[b].centre;
        state.molecule_mass[molecule] += state.bodies[b].mass;
    }
    for (std::size_t i = 0; i < tree.bases.size(); ++i) {
        state.points[tree.bases[i]] /= state.molecule_mass[i];
    }
    for (std::size_t b = 0; b < state.bodies.size(); ++b) {
        const std::uint32_t molecule = tree.molecule_of[b];
        const Vec3 arm = state.bodies[b].centre - state.points[tree.bases[molecule]];
        state.gyration[molecule] +=
            state.bodies[b].spread + state.bodies[b].mass * arm.squaredNorm();
    }
    for (std::size_t i = 0; i < tree.bases.size(); ++i) {
        state.gyration[i] = std::sqrt(state.gyration[i] / state.molecule_mass[i]);
    }
}

// By Cholesky's factors, m = L L^T and m^-1 = K^T K with K = L^-1. Shorter ways, by blocks of three
// and determinants, cost six digits in large trees.
Mat6 inverse_of_positive(const Mat6& m) {
    Mat6 L, K = Mat6::Zero();
    for (int j = 0; j < 6; ++j) {
        double square = m(j, j);
        for (int k = 0; k < j; ++k) square -= L(j, k) * L(j, k);
        const double inverse = 1 / std::sqrt(square);
        for (int i = j + 1; i < 6; ++i) {
            double product = m(i, j);
            for (int k = 0; k < j; ++k) product -= L(i, k) * L(j, k);
            L(i, j) = product * inverse;
        }
        K(j, j) = inverse;
        for (int i = 0; i < j; ++i) {
            double sum = 0;
            for (int k = i; k < j; ++k) sum -= L(j, k) * K(k, i);
            K(j, i) = sum * inverse;
        }
    }
    return K.transpose().lazyProduct(K);
}

JointInertia joint_inertia(const AssemblyTree& tree, const AssemblyState& state, std::uint32_t link,
                           const Mat6& phi_a, const Mat6& phi_b) {
    JointInertia joint;
    joint.W = inverse_of_positive(phi_a + phi_b);
    joint.gain.setZero();
    joint.D = 0;
    if (is_seam(tree, link) || state.is_active[link] == 0) return joint;
    const Vec3& axis = state.axes[link];
    const Vec6 V_axis = joint.W.leftCols<3>() * axis;
    joint.D = 1 / axis.dot(V_axis.head<3>());
    joint.gain = joint.D * V_axis;
    joint.W -= joint.gain * V_axis.transpose();
    return joint;
}

// With the force from A on B, W u, where for open handles f
//     u = sum_(i in A) phi_ia^T f_i - sum_(j in B) phi_jb^T f_j + beta,   beta = b_a - b_b,
// the handles of A accelerate by -phi_ia W u more and those of B by phi_jb W u.
void join(const AssemblyTree& tree, const AssemblyNode& node, Change change, AssemblyState& state) {
    const std::array sides = sides_of(tree, node);
    const std::array<PartInertia, 2> parts{PartInertia(tree, state, *sides[0].node),
                                           PartInertia(tree, state, *sides[1].node)};
    const std::uint32_t a = sides[0].joined(), b = sides[1].joined();
    JointInertia& joint = state.joints[node.part];
    if (change == Change::Places)
        joint = joint_inertia(tree, state, node.link, parts[0].phi(a, a), parts[1].phi(b, b));
    const Vec6 gamma = joint.W * (parts[0].b(a) - parts[1].b(b));

    for (std::uint32_t j = 0; j < node.handles; ++j) {
        const std::uint32_t side_j = node.side[j], j_there = node.number[j];
        const Mat6& across_j = parts[side_j].phi(j_there, sides[side_j].joined());
        state.b[node.first_handle + j] =
            parts[side_j].b(j_there) - sides[side_j].sign * (across_j * gamma);
        if (change != Change::Places) continue;
        const Mat6 W_across_j = joint.W * across_j.transpose();
        for (std::uint32_t i = 0; i <= j; ++i) {
            const std::uint32_t side_i = node.side[i], i_there = node.number[i];
            const Mat6& across_i = parts[side_i].phi(i_there, sides[side_i].joined());
            Mat6& phi = state.phi[node.first_pair + pair_number(i, j)];
            phi.noalias() = across_i.lazyProduct(W_across_j);
            if (side_i == side_j) phi = parts[side_i].phi(i_there, j_there) - phi;
        }
    }
}

// How the joined handle of a side accelerates under the forces on the side's other handles, with
// nothing on itself.
Vec6 open_acceleration(const AssemblyTree& tree, const AssemblyState& state,
                       const AssemblyNode& node, std::uint32_t side) {
    const AssemblyNode& part = side == 0 ? tree.nodes[node.a] : tree.nodes[node.b];
    if (!part.is_leaf()) {
        const std::uint32_t joined = part.handles - 1;
        Vec6 acceleration = state.b[part.first_handle + joined];
        for (std::uint32_t i = 0; i < node.handles; ++i) {
            if (node.side[i] != side) continue;
            const Mat6& phi = state.phi[part.first_pair + pair_number(node.number[i], joined)];
            acceleration += phi.transpose() * state.f[node.first_handle + i];
        }
        return acceleration;
    }
    // The same as rigid_phi, without matrices.
    const BodyState& body = state.bodies[part.body];
    const double copies = tree.copies[part.body];
    Vec3 torque = body.torque / copies, force = body.force / copies;
    for (std::uint32_t i = 0; i < node.handles; ++i) {
        if (node.side[i] != side) continue;
        const Vec6& f = state.f[node.first_handle + i];
        const Vec3 arm = state.points[node.links[i]] - body.centre;
        torque += f.head<3>() + arm.cross(f.tail<3>());
        force += f.tail<3>();
    }
    const Vec3 turn = copies * (body.inverse_inertia * torque);
    Vec6 acceleration;
    acceleration << turn,
        copies / body.mass * force + turn.cross(state.points[node.link] - body.centre);
    return acceleration;
}

// What of a body is not as the state has it.
Change find_change(const AssemblyTree& tree, std::uint32_t body, std::span<const Vec3> positions,
                   std::span<const Vec3> forces, const AssemblyState& state) {
    const auto has_moved = [&](std::uint32_t atom) {
        return positions[atom] != state.positions[atom];
    };
    for (std::uint32_t i = tree.first_share[body]; i < tree.first_share[body + 1]; ++i) {
        if (has_moved(tree.shares[i].atom)) return Change::Places;
    }
    Change change = Change::None;
    for (std::uint32_t i = tree.first_atom[body]; i < tree.first_atom[body + 1]; ++i) {
        const std::uint32_t atom = tree.atoms[i];
        if (has_moved(atom)) return Change::Places;
        if (forces[atom] != state.forces[atom]) change = Change::Forces;
    }
    return change;
}

void update_joint(const AssemblyTree& tree, std::uint32_t body, std::span<const Vec3> positions,
                  AssemblyState& state) {
    if (tree.bodies.is_base(body)) return;
    const auto [j, k] = tree.bodies.bodies[body].axis;
    state.points[body] = positions[k];
    state.axes[body] = (positions[k] - positions[j]).normalized();
}

// A joined part is as much out of date as the worse of its two.
void mark_changes(const AssemblyTree& tree, std::span<const Change> of_bodies,
                  std::span<Change> changes) {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const AssemblyNode& node = tree.nodes[i];
        changes[i] =
            node.is_leaf() ? of_bodies[node.body] : std::max(changes[node.a], changes[node.b]);
    }
}

// What pushes a base that is guided at a point and turns about that: a force there alone, which
// gives the point the acceleration that it has to have.
Vec6 force_at_point(const Mat6& phi, const Vec6& b, const Vec3& arm, const Vec3& acceleration) {
    Eigen::Matrix<double, 3, 6> motion;  // of the point, from that of the ground's
    motion << -cross_matrix(arm), Mat3::Identity();
    const Mat3 inverse_mass = motion * phi * motion.transpose();
    return motion.transpose() * inverse_mass.llt().solve(acceleration - motion * b);
}

}  // namespace

void update_inertia(const AssemblyTree& tree, std::uint32_t body, std::span<const Vec3> positions,
                    BodyState& state) noexcept {
    const auto shares =
        std::span(tree.shares)
            .subspan(tree.first_share[body], tree.first_share[body + 1] - tree.first_share[body]);
    double mass = 0;
    Vec3 moment = Vec3::Zero();
    for (const AtomShare& share : shares) {
        mass += share.mass;
        moment += share.mass * positions[share.atom];
    }
    state.centre = moment / mass;
    state.mass = mass;

    // I = sum of m (r^2 - r r^T)
    Mat3 spread = Mat3::Zero();
    for (const AtomShare& share : shares) {
        const Vec3 arm = positions[share.atom] - state.centre;
        spread += share.mass * arm * arm.transpose();
    }
    state.spread = spread.trace();
    const Mat3 inertia = state.spread * Mat3::Identity() - spread;
    state.inverse_inertia =
        tree.is_linear[body] != 0 ? pseudo_inverse(inertia) : Mat3(inertia.inverse());
}

void update_wrench(const AssemblyTree& tree, std::uint32_t body, std::span<const Vec3> positions,
                   std::span<const Vec3> forces, BodyState& state) noexcept {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (std::uint32_t i = tree.first_atom[body]; i < tree.first_atom[body + 1]; ++i) {
        const std::uint32_t atom = tree.atoms[i];
        force += forces[atom];
        torque += (positions[atom] - state.centre).cross(forces[atom]);
    }
    state.force = force;
    state.torque = torque;
}

void update_links(const AssemblyTree& tree, AssemblyState& state) noexcept {
    place_grounds(tree, state);
    if (tree.links == tree.bodies.bodies.size()) return;
    for (const AssemblyNode& node : tree.nodes) {
        if (!node.is_leaf() || tree.copies[node.body] == 1) continue;
        for (std::uint32_t i = 0; i < node.handles; ++i) {
            if (!is_seam(tree, node.links[i])) continue;
            state.points[node.links[i]] = state.bodies[node.body].centre;
        }
    }
}

// Of a copy of a body: an n-th of its mass and of its forces.
PartInertia::PartInertia(const AssemblyTree& tree, const AssemblyState& state,
                         const AssemblyNode& node) noexcept {
    if (!node.is_leaf()) {
        phi_ = &state.phi[node.first_pair];
        b_ = &state.b[node.first_handle];
        return;
    }
    const BodyState& body = state.bodies[node.body];
    const double copies = tree.copies[node.body];
    const Vec3 turn = body.inverse_inertia * body.torque;
    for (std::uint32_t j = 0; j < node.handles; ++j) {
        const Vec3 r_j = state.points[node.links[j]] - body.centre;
        leaf_b_[j] << turn, body.force / body.mass + turn.cross(r_j);
        for (std::uint32_t i = 0; i <= j; ++i) {
            const Vec3 r_i = state.points[node.links[i]] - body.centre;
            leaf_phi_[pair_number(i, j)] = copies * rigid_phi(body, r_i, r_j);
        }
    }
}

AssemblyState build_assembly_state(const AssemblyTree& tree) {
    const std::size_t bodies = tree.bodies.bodies.size(), molecules = tree.roots.size();
    AssemblyState state;
    state.is_active.assign(bodies, 1);
    state.guides.assign(molecules, {});
    state.bodies.resize(bodies);
    state.molecule_mass.assign(molecules, 0);
    state.gyration.assign(molecules, 0);
    state.points.assign(tree.links, Vec3::Zero());
    state.axes.assign(bodies, Vec3::Zero());
    state.positions.assign(tree.atoms.size(), Vec3::Zero());
    state.forces.assign(tree.atoms.size(), Vec3::Zero());
    state.changes.assign(tree.nodes.size(), Change::Places);
    state.phi.assign(tree.pairs, Mat6::Zero());
    state.b.assign(tree.handles, Vec6::Zero());
    state.joints.assign(tree.parts, {Mat6::Zero(), Vec6::Zero(), 0});
    state.f.assign(tree.handles, Vec6::Zero());
    state.joint_acceleration.assign(bodies, 0);
    state.base_acceleration.assign(molecules, Vec6::Zero());
    state.base_force.assign(molecules, Vec6::Zero());
    return state;
}

void update_bodies(const AssemblyTree& tree, std::span<const Vec3> positions,
                   std::span<const Vec3> forces, AssemblyState& state) noexcept {
    PALPA_ASSERT(positions.size() == tree.atoms.size() && forces.size() == tree.atoms.size());
    for (std::uint32_t b = 0; b < state.bodies.size(); ++b) {
        update_inertia(tree, b, positions, state.bodies[b]);
        update_wrench(tree, b, positions, forces, state.bodies[b]);
        update_joint(tree, b, positions, state);
    }
    update_links(tree, state);
    std::ranges::copy(positions, state.positions.begin());
    std::ranges::copy(forces, state.forces.begin());
    std::ranges::fill(state.changes, Change::Places);
}

void update_changed_bodies(const AssemblyTree& tree, std::span<const Vec3> positions,
                           std::span<const Vec3> forces, AssemblyState& state) {
    std::vector<Change> of_bodies;
    for (std::uint32_t b = 0; b < state.bodies.size(); ++b) {
        const Change change = find_change(tree, b, positions, forces, state);
        of_bodies.push_back(change);
        if (change == Change::Places) {
            update_inertia(tree, b, positions, state.bodies[b]);
            update_joint(tree, b, positions, state);
        }
        if (change != Change::None) update_wrench(tree, b, positions, forces, state.bodies[b]);
    }
    std::vector<Vec3> grounds;
    for (const std::uint32_t base : tree.bases) grounds.push_back(state.points[base]);
    update_links(tree, state);
    for (std::size_t m = 0; m < grounds.size(); ++m) {
        if (grounds[m] != state.points[tree.bases[m]]) of_bodies[tree.bases[m]] = Change::Places;
    }
    std::ranges::copy(positions, state.positions.begin());
    std::ranges::copy(forces, state.forces.begin());
    mark_changes(tree, of_bodies, state.changes);
}

void upward_pass(const AssemblyTree& tree, AssemblyState& state) noexcept {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const Change change = state.changes[i];
        if (tree.nodes[i].is_leaf() || change == Change::None) continue;
        join(tree, tree.nodes[i], change, state);
    }
}

Vec6 push_for(const AssemblyTree& tree, std::size_t molecule, const Mat6& phi,
              const Vec6& acceleration) noexcept {
    if (tree.is_linear[tree.bases[molecule]] == 0) return phi.llt().solve(acceleration);
    // Nothing pushes along what has no inertia.
    const auto [values, axes] = find_eigenvectors(phi);
    Vec6 push = Vec6::Zero();
    for (int i = 0; i < 6; ++i) {
        if (values[i] > 1e-12 * values[5])
            push += axes.col(i) * (axes.col(i).dot(acceleration) / values[i]);
    }
    return push;
}

BaseMotion find_base_motion(const AssemblyTree& tree, const AssemblyState& state,
                            std::size_t molecule, const PartInertia& root) noexcept {
    const auto& [guide, acceleration, point] = state.guides[molecule];
    const Mat6& phi = root.phi(0, 0);
    const Vec6& b = root.b(0);
    Vec6 f = Vec6::Zero();
    if (guide == BaseGuide::Whole || state.is_active[tree.bases[molecule]] == 0) {
        Vec6 wanted = Vec6::Zero();
        if (guide == BaseGuide::Whole) wanted = acceleration;
        if (guide == BaseGuide::Point) wanted.tail<3>() = acceleration.tail<3>();
        f = push_for(tree, molecule, phi, wanted - b);
    } else if (guide == BaseGuide::Point) {
        f = force_at_point(phi, b, arm_of_guide(tree, state, molecule), acceleration.tail<3>());
    }
    return {phi * f + b, f};
}

void update_base(const AssemblyTree& tree, std::size_t molecule, AssemblyState& state) noexcept {
    const AssemblyNode& root = tree.nodes[tree.roots[molecule]];
    const auto [acceleration, force] =
        find_base_motion(tree, state, molecule, PartInertia(tree, state, root));
    state.base_acceleration[molecule] = acceleration;
    state.base_force[molecule] = force;
    if (!root.is_leaf()) state.f[root.first_handle] = force;
}

void separate(const AssemblyTree& tree, std::size_t number, AssemblyState& state) noexcept {
    const AssemblyNode& node = tree.nodes[number];
    const JointInertia& joint = state.joints[node.part];
    const Vec6 u =
        open_acceleration(tree, state, node, 0) - open_acceleration(tree, state, node, 1);
    if (!is_seam(tree, node.link)) state.joint_acceleration[node.link] = -joint.gain.dot(u);

    const Vec6 force = joint.W * u;  // from A on B
    const std::array sides = sides_of(tree, node);
    for (const Side& side : sides) {
        if (side.node->is_leaf()) continue;
        state.f[side.node->first_handle + side.joined()] = -side.sign * force;
    }
    for (std::uint32_t i = 0; i < node.handles; ++i) {
        const AssemblyNode& part = *sides[node.side[i]].node;
        if (part.is_leaf()) continue;
        state.f[part.first_handle + node.number[i]] = state.f[node.first_handle + i];
    }
}

void downward_pass(const AssemblyTree& tree, AssemblyState& state) noexcept {
    for (std::size_t molecule = 0; molecule < tree.roots.size(); ++molecule) {
        update_base(tree, molecule, state);
    }
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        if (!tree.nodes[i].is_leaf()) separate(tree, i, state);
    }
}

void update_accelerations(const AssemblyTree& tree, std::span<const Vec3> positions,
                          std::span<const Vec3> forces, AssemblyState& state) noexcept {
    update_bodies(tree, positions, forces, state);
    upward_pass(tree, state);
    downward_pass(tree, state);
}

}  // namespace palpa
