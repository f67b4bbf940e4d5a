#include "haptics/local_field.h"

#include "core/repeatable.h"
#include "core/units.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa {
namespace {

constexpr double newton = units::newton_per_kcal_per_mol_angstrom;
constexpr double joule = units::joule_per_kcal_per_mol;
constexpr double newton_per_metre = units::newton_per_metre_per_kcal_per_mol_angstrom2;

// Where the hand has it by now.
const MoleculePose& live_pose(const HeldField& held, LiveMolecules live) noexcept {
    if (held.hand >= live.size()) return held.then.pose;
    const std::optional<LiveMolecule>& now = live[held.hand];
    return now && now->grip_number == held.then.grip_number ? now->pose : held.then.pose;
}

// From one pose to another, of a molecule whose reference atom was at `pivot`.
RigidMotion motion_between(const MoleculePose& from, const MoleculePose& to,
                           const Vec3& pivot) noexcept {
    RigidMotion motion;
    motion.rotation = (to.orientation * from.orientation.conjugate()).toRotationMatrix();
    motion.translation = to.place_angstrom - from.place_angstrom;
    motion.translation += pivot - motion.rotation * pivot;
    return motion;
}

// As seen from the world, of a sum over a body that `motion` has moved, as seen from that body.
FrozenSum seen_from_world(FrozenSum sum, const RigidMotion& motion) noexcept {
    sum.force = motion.rotation * sum.force;
    sum.torque = motion.rotation * sum.torque + motion.translation.cross(sum.force);
    sum.stiffness = motion.rotation * sum.stiffness * motion.rotation.transpose();
    return sum;
}

// The sum of two; the clearance is the nearer one's, the largest force a bound.
void add(FrozenSum& sum, const FrozenSum& other) noexcept {
    sum.force += other.force;
    sum.torque += other.torque;
    sum.stiffness += other.stiffness;
    sum.clearance = std::min(sum.clearance, other.clearance);
    sum.largest_force += other.largest_force;
}

// Of what other hands hold, on a group elsewhere.
void add_held(const LocalField& field, std::span<const Vec3> group, const RigidMotion& motion,
              LiveMolecules live, FrozenSum& sum) noexcept {
    for (const HeldField& held : field.held) {
        const RigidMotion other = motion_between(held.then.pose, live_pose(held, live), held.pivot);
        const RigidMotion seen = other.inverse() * motion;
        add(sum, seen_from_world(evaluate_frozen_field(held.frozen, group, seen), other));
    }
}

LocalForce evaluate_tangent(const ContactModel& model, const LocalField& field,
                            const MoleculePose& pose, LiveMolecules live) noexcept {
    const Vec3 moved = pose.place_angstrom - model.molecule.place_angstrom;
    LocalForce result;
    result.stiffness_N_per_m = model.stiffness_matrix_N_per_m;
    result.force_newton =
        model.force_newton - model.stiffness_matrix_N_per_m * moved * units::metre_per_angstrom;
    result.torque_newton_metre = model.torque_newton_metre;
    double nearer = moved.norm();
    for (const HeldField& held : field.held) {
        const Vec3 went = live_pose(held, live).place_angstrom - held.then.pose.place_angstrom;
        result.force_newton += newton * (model.projector * (held.at_step.stiffness * went));
        nearer += went.norm();
    }
    result.clearance_angstrom = std::max(0.0, model.clearance_angstrom - nearer);
    result.largest_newton = result.force_newton.norm();
    return result;
}

// Torque about the centre of mass, from that about the reference atom, `arm` away from it.
Vec3 torque_about_centre(const Vec6& pull, const Vec3& arm) noexcept {
    return pull.head<3>() - (units::metre_per_angstrom * arm).cross(Vec3(pull.tail<3>()));
}

// Force and torque to first order where everything follows the hands.
void add_relaxed(const ContactModel& model, const LocalField& field, const MoleculePose& pose,
                 LiveMolecules live, LocalForce& result) noexcept {
    const Quat turn = model.turns_with_handle
                          ? Quat(pose.orientation * model.molecule.orientation.conjugate())
                          : Quat::Identity();
    const Vec3 arm = field.centre - field.pivot;
    Vec6 pull;
    pull.tail<3>() = model.force_newton;
    pull.head<3>() =
        model.torque_newton_metre + (units::metre_per_angstrom * arm).cross(model.force_newton);
    Vec6 moved;
    moved.head<3>() = rotation_vector_of(turn);
    moved.tail<3>() =
        units::metre_per_angstrom * (pose.place_angstrom - model.molecule.place_angstrom);
    pull -= model.relaxed->matrix * moved;
    for (const HeldField& held : field.held) {
        const Vec3 went = live_pose(held, live).place_angstrom - held.then.pose.place_angstrom;
        pull.tail<3>() -= units::metre_per_angstrom * (held.relaxed_N_per_m * went);
    }
    result.force_newton += pull.tail<3>();
    result.torque_newton_metre = torque_about_centre(pull, turn * arm);
    result.slope_N_per_m += model.relaxed->matrix.bottomRightCorner<3, 3>();
}

RigidMotion motion_to(const ContactModel& model, const LocalField& field,
                      const MoleculePose& pose) noexcept {
    if (model.turns_with_handle) return motion_between(model.molecule, pose, field.pivot);
    return {Mat3::Identity(), pose.place_angstrom - model.molecule.place_angstrom};
}

// In the frozen field, or by its tangent.
LocalForce evaluate_frozen(const ContactModel& model, const LocalField& field,
                           const MoleculePose& pose, LiveMolecules live) noexcept {
    if (!field.has_atoms) return evaluate_tangent(model, field, pose, live);
    const Mat3& free = model.projector;
    const RigidMotion motion = motion_to(model, field, pose);
    const FrozenSum sum = evaluate_field(field, field.group, motion, live);
    const FrozenSum there = sum_at_step(field);
    LocalForce result;
    result.force_newton =
        model.force_newton + model.prediction_gain * newton * (free * (sum.force - there.force));
    const Vec3 torque = sum.torque_about(motion * field.centre);
    result.torque_newton_metre =
        model.torque_newton_metre +
        model.torque_prediction_gain * joule * (torque - there.torque_about(field.centre));
    result.stiffness_N_per_m =
        model.prediction_gain * newton_per_metre * (free * sum.stiffness * free);
    result.clearance_angstrom = std::max(0.0, sum.clearance);
    result.largest_newton = std::max(newton * sum.largest_force, result.force_newton.norm());
    return result;
}

// Among atoms that follow; of the force what is beyond first order.
LocalForce evaluate_following(const ContactModel& model, const LocalField& field,
                              const MoleculePose& pose, LiveMolecules live) noexcept {
    const Mat3& free = model.projector;
    const FollowingAtoms& atoms = *field.following;
    const RigidMotion motion = motion_to(model, field, pose);
    const double length = motion.translation.norm();
    const bool is_within = length <= atoms.reach_angstrom;
    const Vec3 by = motion.translation * (is_within ? 1 : atoms.reach_angstrom / length);
    FollowingSum now =
        evaluate_following_field(field.frozen, field.group, atoms.points, by, atoms.memory);
    add_held(field, field.group, motion, live, now.sum);
    LocalForce result;
    result.force_newton =
        newton * (free * (now.along - atoms.at_step.along + atoms.at_step.slope * by));
    if (is_within)
        result.slope_N_per_m = newton_per_metre * (free * (now.slope - atoms.at_step.slope) * free);
    result.stiffness_N_per_m = newton_per_metre * (free * now.sum.stiffness * free);
    result.clearance_angstrom = std::max(0.0, now.sum.clearance);
    result.largest_newton = newton * now.sum.largest_force;
    return result;
}

}  // namespace

FrozenSum sum_at_step(const LocalField& field) noexcept {
    FrozenSum there = field.at_step;
    for (const HeldField& held : field.held) add(there, held.at_step);
    return there;
}

FrozenSum evaluate_field(const LocalField& field, std::span<const Vec3> group,
                         const RigidMotion& motion, LiveMolecules live) noexcept {
    FrozenSum sum = evaluate_frozen_field(field.frozen, group, motion);
    add_held(field, group, motion, live, sum);
    return sum;
}

LocalForce evaluate_local(const ContactModel& model, const LocalField& field,
                          const MoleculePose& pose, LiveMolecules live) noexcept {
    if (model.relaxed && field.following) {
        LocalForce result = evaluate_following(model, field, pose, live);
        add_relaxed(model, field, pose, live, result);
        result.largest_newton = std::max(result.largest_newton, result.force_newton.norm());
        return result;
    }
    LocalForce result = evaluate_frozen(model, field, pose, live);
    result.slope_N_per_m = result.stiffness_N_per_m;
    if (!model.relaxed) return result;
    result.force_newton.setZero();
    result.slope_N_per_m.setZero();
    add_relaxed(model, field, pose, live, result);
    return result;
}

double extreme_stiffness(const Mat3& stiffness) noexcept {
    // The eigenvalues of a symmetric matrix of three rows are mean + 2 spread cos(angle + 2 k pi/3)
    // (O. K. Smith, Commun. ACM 4, 168, 1961).
    Mat3 rest = stiffness.selfadjointView<Eigen::Lower>();
    const double mean = rest.trace() / 3;
    rest.diagonal().array() -= mean;
    const double spread = std::sqrt(rest.squaredNorm() / 6);
    if (spread == 0) return mean;
    const double cosine = std::clamp(0.5 * Mat3(rest / spread).determinant(), -1.0, 1.0);
    const double angle = repeatable::atan2(std::sqrt(1 - cosine * cosine), cosine) / 3;
    const double highest = mean + 2 * spread * repeatable::cos(angle);
    const double lowest = mean + 2 * spread * repeatable::cos(angle + 2 * std::numbers::pi / 3);
    return std::abs(lowest) > std::abs(highest) ? lowest : highest;
}

}  // namespace palpa
