// Joint accelerations of molecules at rest by divide and conquer: up the assembly tree and down.
//
// How a part accelerates at its handles depends on the forces there, for all i and j of them, by
//     a_i = sum_j phi_ij f_j + b_i
// with inverse inertias phi and the bias b that forces on atoms cause. Joining two parts removes
// two handles; the equations of the joint give phi and b of what remains (R. Featherstone 1999).
#pragma once
#include "assembly/tree.h"
#include "math/spatial.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// What a joint makes of the two parts that it joins, with V = (phi_A + phi_B)^-1 at the two handles
// and S = (axis, 0), the way in which B may move against A:
//     D = (S^T V S)^-1,   W = V - V S D S^T V,   gain = D S^T V,
// and in a rigid joint W = V, gain = 0. What acts from A on B is W u, and the joint's acceleration
// is -gain u, where u is the acceleration of A less that of B at the joint as if it were open.
struct JointInertia {
    Mat6 W;
    Vec6 gain;
    double D;  // 1/(amu Å^2): inverse of the inertia that a torque on the joint meets; 0 if rigid
};

// A body with the atoms that it shares, and all forces on its own.
struct BodyState {
    double mass;           // amu
    Vec3 centre;           // of mass, Å
    Mat3 inverse_inertia;  // about the centre, 1/(amu Å^2)
    double spread;         // sum of m r^2 about the centre, amu Å^2
    Vec3 torque;           // about the centre, kcal/mol
    Vec3 force;            // kcal/mol/Å
};

// What a guide prescribes for a base.
enum class BaseGuide : std::uint8_t {
    None,   // nothing
    Point,  // the acceleration of one point; the base turns freely about it
    Whole,  // the whole motion; a fixed base is held at rest
};

// Degrees of freedom that the guide leaves to a base.
constexpr std::size_t degrees_of_freedom(BaseGuide guide) noexcept {
    return guide == BaseGuide::None ? 6 : guide == BaseGuide::Point ? 3 : 0;
}

struct GuidedBase {
    BaseGuide guide = BaseGuide::None;
    // Of Point the linear part alone counts. What is not prescribed and may not move either has 0.
    Vec6 acceleration = Vec6::Zero();  // at the point
    // Of Point, Å, moves with the base; none for the molecule's centre of mass, where that of Whole
    // always is.
    std::optional<Vec3> point;
};

// What is out of date in a part: nothing, what depends on forces, or everything.
enum class Change : std::uint8_t { None, Forces, Places };

// Quantities of joined parts: those of handles stand at AssemblyNode::first_handle, those of pairs
// of handles (i, j) with i <= j at first_pair + pair_number(i, j). Those of leaves follow from
// BodyState and are computed where they are needed, which costs less than to fetch them. Spatial
// vectors have the world's axes and are taken at the point of the handle's link. The unit of time
// is AKMA's, in which kcal/mol is amu Å^2/time^2.
struct AssemblyState {
    // The caller writes what may move. One entry per body: its joint, or for a base the degrees of
    // freedom that its guide leaves. What is not active stays rigid. All are active at first.
    std::vector<std::uint8_t> is_active;
    // Written by the caller: the guides of the bases; none at first.
    std::vector<GuidedBase> guides;  // one per molecule

    // update_bodies. A joint's point is the atom at the end of its axis, the ground's the centre of
    // mass of its molecule, a seam's the centre of its body.
    std::vector<BodyState> bodies;
    std::vector<double> molecule_mass;  // amu
    std::vector<double> gyration;       // radius of gyration of each molecule, Å
    std::vector<Vec3> points;           // point of each link, Å
    std::vector<Vec3> axes;             // axis of each joint, unit vector
    std::vector<Vec3> positions,
        forces;  // positions and forces of the atoms for which all this was computed
    // Of each node; the passes over all of them renew no more than that. All places at first.
    std::vector<Change> changes;

    // upward_pass.
    std::vector<Mat6> phi;             // of pairs of handles
    std::vector<Vec6> b;               // of handles
    std::vector<JointInertia> joints;  // of each joined part

    // downward_pass.
    std::vector<Vec6> f;                     // force on each handle from outside of its part
    std::vector<double> joint_acceleration;  // of each body's joint, rad/time^2; 0 for bases
    std::vector<Vec6> base_acceleration;     // for each molecule, at the point of its ground link
    // Of each molecule: what holds or guides its base, at the same point; 0 if free.
    std::vector<Vec6> base_force;
};

constexpr std::uint32_t pair_number(std::uint32_t i, std::uint32_t j) noexcept {
    return j * (j + 1) / 2 + i;
}

// A state with the right sizes and everything active.
AssemblyState build_assembly_state(const AssemblyTree& tree);

// Updates mass properties of the bodies, and points and axes of the links. One position (Å) and one
// force (kcal/mol/Å) per atom.
void update_bodies(const AssemblyTree& tree, std::span<const Vec3> positions,
                   std::span<const Vec3> forces, AssemblyState& state) noexcept;

// The same, telling apart what is not what it was in the state, bit for bit. What may move must be
// what it was. upward_pass, and update_metric where that is in use, have to follow each time.
void update_changed_bodies(const AssemblyTree& tree, std::span<const Vec3> positions,
                           std::span<const Vec3> forces, AssemblyState& state);

// From the leaves to the roots: phi, b and the joints' inertias. Many rigid joints in a row cost
// digits, since a part that is larger and larger is had from differences; hybrid.h sums it instead.
void upward_pass(const AssemblyTree& tree, AssemblyState& state) noexcept;

// At a root: a base is pushed by what makes it accelerate as it has to, if it has to.
void update_base(const AssemblyTree& tree, std::size_t molecule, AssemblyState& state) noexcept;

// At a joined part whose handles have their forces: its joint's acceleration, and the forces on the
// handles of its two parts.
void separate(const AssemblyTree& tree, std::size_t node, AssemblyState& state) noexcept;

// From the roots to the leaves: forces on handles, and with them the accelerations.
void downward_pass(const AssemblyTree& tree, AssemblyState& state) noexcept;

// update_bodies, upward_pass and downward_pass.
void update_accelerations(const AssemblyTree& tree, std::span<const Vec3> positions,
                          std::span<const Vec3> forces, AssemblyState& state) noexcept;

}  // namespace palpa
