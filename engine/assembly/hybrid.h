// Molecules of which few joints turn: rigid clusters of bodies, and an assembly tree of these
// alone.
//
// What is joined by joints at rest is one rigid cluster. Clusters and the joints between them are
// bodies and joints of a smaller tree, balanced as any other, so that passes, metric and selection
// are those of AssemblyTree: their work goes by the joints that turn, not by those that there are.
#pragma once
#include "assembly/passes.h"
#include "math/rigid_motion.h"

#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// A cluster in its own frame: the origin at its centre of mass, the axes the world's as they were
// when the tree was built. Its inertia and atoms are summed once.
struct Cluster {
    double mass;           // amu
    Mat3 inverse_inertia;  // about the centre, 1/(amu Å^2)
    double spread;         // as in BodyState
    Vec3 joint_point;      // point of the joint to its parent, Å
    Vec3 joint_axis;       // length 1
};

struct HybridTree {
    // Its bodies are the clusters, its joints those that are active, its molecules those of the
    // whole tree in the same order. The atoms of cluster c stand at [first_atom[c], first_atom[c +
    // 1]) of `atoms`.
    AssemblyTree tree;
    std::vector<std::uint32_t> cluster_of;  // cluster of each body of the whole tree
    std::vector<std::uint32_t> body_of;     // for each cluster: the body whose joint or base it has
    std::vector<Cluster> clusters;
    std::vector<Vec3> places;   // positions of tree.atoms in the frame of their cluster, Å
    std::vector<Vec3> centres;  // initial centre of each cluster, Å
};

struct HybridState {
    // Of the tree of clusters; all its joints are active. The caller writes guides and which bases
    // are active, and the wrenches (BodyState::torque and force) where update_wrenches does not.
    AssemblyState passes;

    // move_clusters.
    std::vector<Eigen::Quaterniond>
        orientations;                  // orientation of each cluster's frame in the world
    std::vector<Vec3> centres;         // centre of mass of each cluster, Å
    std::vector<RigidMotion> motions;  // last motion of each cluster
};

// One entry per body of the whole tree says what is active, as JointSelection has it; those of
// bases count nothing here.
HybridTree build_hybrid_tree(const AssemblyTree& whole, std::span<const std::uint8_t> is_active,
                             std::span<const Vec3> positions);

// The state at the positions for which the tree was built, with the same entries for the bases. One
// guide per molecule.
HybridState build_hybrid_state(const HybridTree& hybrid, std::span<const std::uint8_t> is_active,
                               std::span<const GuidedBase> guides);

// The wrench on each cluster about its centre, from the forces on all atoms, kcal/mol/Å.
void update_wrenches(const HybridTree& hybrid, std::span<const Vec3> positions,
                     std::span<const Vec3> forces, HybridState& state) noexcept;

// Updates inertias, points and axes of the clusters for their present positions.
void update_clusters(const HybridTree& hybrid, HybridState& state) noexcept;

// update_clusters and both passes, with the wrenches that the state holds.
void update_accelerations(const HybridTree& hybrid, HybridState& state) noexcept;

// Turns the joint of each cluster by an angle (rad; of bases not looked at), and each base by a
// rotation vector about the ground's point of its molecule, then by a shift (Å); the point at which
// it is guided goes along. Points and axes are those of update_clusters.
void move_clusters(const HybridTree& hybrid, std::span<const double> joint_turns,
                   std::span<const Vec6> base_moves, HybridState& state) noexcept;

// Indices of a cluster's atoms.
std::span<const std::uint32_t> atoms_of(const HybridTree& hybrid, std::size_t cluster) noexcept;

// Updates the positions of one cluster's atoms.
void update_positions(const HybridTree& hybrid, const HybridState& state, std::uint32_t cluster,
                      std::span<Vec3> positions) noexcept;

// Updates the positions of all atoms.
void update_positions(const HybridTree& hybrid, const HybridState& state,
                      std::span<Vec3> positions) noexcept;

}  // namespace palpa
