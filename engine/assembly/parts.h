// Access to the parts of an assembly tree for the passes over it.
#pragma once
#include "assembly/passes.h"

#include <array>
#include <cstdint>
#include <span>

namespace palpa {

// The stages of update_bodies: mass, centre and inertia; torque and force about the centre; where
// links to the ground and seams are, from the bodies.
void update_inertia(const AssemblyTree& tree, std::uint32_t body, std::span<const Vec3> positions,
                    BodyState& state) noexcept;
void update_wrench(const AssemblyTree& tree, std::uint32_t body, std::span<const Vec3> positions,
                   std::span<const Vec3> forces, BodyState& state) noexcept;
void update_links(const AssemblyTree& tree, AssemblyState& state) noexcept;

// Vector from the ground's point to the point at which the base is guided, Å.
inline Vec3 arm_of_guide(const AssemblyTree& tree, const AssemblyState& state,
                         std::size_t molecule) noexcept {
    const Vec3& ground = state.points[tree.bases[molecule]];
    return state.guides[molecule].point.value_or(ground) - ground;
}

inline bool is_seam(const AssemblyTree& tree, std::uint32_t link) noexcept {
    return link >= tree.bodies.bodies.size();
}

// phi and b of a part's handles: of a joined part those of the state, of a leaf its own.
class PartInertia {
public:
    PartInertia(const AssemblyTree& tree, const AssemblyState& state,
                const AssemblyNode& node) noexcept;
    PartInertia(const PartInertia&) = delete;
    PartInertia& operator=(const PartInertia&) = delete;

    // i <= j
    const Mat6& phi(std::uint32_t i, std::uint32_t j) const noexcept {
        return phi_[pair_number(i, j)];
    }
    const Vec6& b(std::uint32_t i) const noexcept { return b_[i]; }

private:
    std::array<Mat6, 6> leaf_phi_;
    std::array<Vec6, 3> leaf_b_;
    const Mat6* phi_ = leaf_phi_.data();
    const Vec6* b_ = leaf_b_.data();
};

// Acceleration and force of a base, at the ground's point.
struct BaseMotion {
    Vec6 acceleration, force;  // force is 0 unless the base is held or guided
};

BaseMotion find_base_motion(const AssemblyTree& tree, const AssemblyState& state,
                            std::size_t molecule, const PartInertia& root) noexcept;

// The push on the base of a molecule that makes it accelerate so, from nothing. An ion or a
// molecule whose atoms are in line cannot be turned in every direction.
Vec6 push_for(const AssemblyTree& tree, std::size_t molecule, const Mat6& phi,
              const Vec6& acceleration) noexcept;

// One of the two parts of a joined part. The joined handle is its last.
struct Side {
    const AssemblyNode* node;
    double sign;  // sign of the acceleration of the joined handle in u = a_A - a_B

    std::uint32_t joined() const noexcept { return node->handles - 1; }
};

inline std::array<Side, 2> sides_of(const AssemblyTree& tree, const AssemblyNode& node) noexcept {
    return {Side{&tree.nodes[node.a], 1}, Side{&tree.nodes[node.b], -1}};
}

}  // namespace palpa
