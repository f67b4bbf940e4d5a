#include "haptics/local_field.h"

#include "core/units.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

constexpr double newton = units::newton_per_kcal_per_mol_angstrom;
constexpr double joule = units::joule_per_kcal_per_mol;
constexpr double newton_per_metre = units::newton_per_metre_per_kcal_per_mol_angstrom2;

LocalForce evaluate_tangent(const TouchModel& model, const Vec3& moved) noexcept {
    LocalForce result;
    result.stiffness_N_per_m = model.stiffness_matrix_N_per_m;
    result.force_newton =
        model.force_newton - model.stiffness_matrix_N_per_m * moved * units::metre_per_angstrom;
    result.torque_newton_metre = model.torque_newton_metre;
    result.clearance_angstrom = std::max(0.0, model.clearance_angstrom - moved.norm());
    result.largest_newton = result.force_newton.norm();
    return result;
}

}  // namespace

LocalForce evaluate_local(const TouchModel& model, const LocalField& field,
                          const MoleculePose& pose) noexcept {
    const Mat3& free = model.projector;
    const Vec3 moved = pose.place_angstrom - model.molecule.place_angstrom;
    if (!field.has_atoms) return evaluate_tangent(model, moved);
    RigidMotion motion{Mat3::Identity(), moved};
    if (model.turns_with_handle) {
        motion.rotation =
            (pose.orientation * model.molecule.orientation.conjugate()).toRotationMatrix();
        motion.translation += field.pivot - motion.rotation * field.pivot;
    }
    const FrozenSum sum = evaluate_frozen_field(field.frozen, field.group, motion);
    LocalForce result;
    result.force_newton =
        model.force_newton + model.confirmed * newton * (free * (sum.force - field.there.force));
    const Vec3 torque = sum.torque_about(motion * field.centre);
    result.torque_newton_metre =
        model.torque_newton_metre +
        model.confirmed_torque * joule * (torque - field.there.torque_about(field.centre));
    result.stiffness_N_per_m = model.confirmed * newton_per_metre * (free * sum.stiffness * free);
    result.clearance_angstrom = std::max(0.0, sum.clearance);
    result.largest_newton = std::max(newton * sum.largest_force, result.force_newton.norm());
    return result;
}

double extreme_stiffness(const Mat3& stiffness) noexcept {
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(stiffness, Eigen::EigenvaluesOnly);
    const double lowest = solver.eigenvalues()(0), highest = solver.eigenvalues()(2);
    return std::abs(lowest) > std::abs(highest) ? lowest : highest;
}

}  // namespace palpa
