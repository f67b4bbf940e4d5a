#include "statics/step_quasi_static.h"

#include "core/assertion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

void read_accelerations(const TorsionModel& model, const AssemblyState& assembly,
                        Coordinates& accelerations) noexcept {
    accelerations.resize(model.coordinates);
    for (std::size_t b = 0; b < model.coordinate_of_body.size(); ++b) {
        const Eigen::Index at = model.coordinate_of_body[b];
        if (at >= 0) accelerations[at] = assembly.joint_acceleration[b];
    }
    for (std::size_t m = 0; m < model.bases.size(); ++m) {
        const Eigen::Index at = model.coordinate_of_base[m];
        if (at < 0) continue;
        accelerations.segment<3>(at) = assembly.base_acceleration[m].head<3>();
        if (model.bases[m].freedom == BaseFreedom::Free)
            accelerations.segment<3>(at + 3) = assembly.base_acceleration[m].tail<3>();
    }
}

// The wrench that does along each coordinate what the forces say.
void put_on_bodies(const TorsionModel& model, const TorsionState& state,
                   const Coordinates& coordinate_forces, AssemblyState& assembly) noexcept {
    for (BodyState& body : assembly.bodies) {
        body.force.setZero();
        body.torque.setZero();
    }
    for (std::size_t b = 0; b < model.coordinate_of_body.size(); ++b) {
        const Eigen::Index at = model.coordinate_of_body[b];
        if (at < 0) continue;
        const Vec3 torque = coordinate_forces[at] * assembly.axes[b];
        assembly.bodies[b].torque += torque;
        assembly.bodies[model.tree.bodies.bodies[b].parent].torque -= torque;
    }
    for (std::size_t m = 0; m < model.bases.size(); ++m) {
        const Eigen::Index at = model.coordinate_of_base[m];
        if (at < 0) continue;
        BodyState& base = assembly.bodies[model.tree.bases[m]];
        base.torque += coordinate_forces.segment<3>(at);
        if (model.bases[m].freedom != BaseFreedom::Free) continue;
        const Vec3 force = coordinate_forces.segment<3>(at + 3);
        base.force += force;
        base.torque += (state.pivots[m] - base.centre).cross(force);
    }
}

}  // namespace

double sum_of_terms(const TorsionState& state) noexcept {
    return state.terms.magnitude() + state.spring_energy;
}

void guide_pivots(const TorsionModel& model, const TorsionState& state,
                  AssemblyState& assembly) noexcept {
    for (std::size_t m = 0; m < model.bases.size(); ++m) {
        if (model.bases[m].freedom == BaseFreedom::Turning)
            assembly.guides[m].point = state.pivots[m];
    }
}

QuasiStatics build_quasi_statics(const TorsionModel& model) {
    QuasiStatics statics;
    statics.assembly = build_assembly_state(model.tree);
    for (std::size_t m = 0; m < model.bases.size(); ++m) {
        BaseGuide& guide = statics.assembly.guides[m].guide;
        if (model.bases[m].freedom == BaseFreedom::Held) guide = BaseGuide::Whole;
        if (model.bases[m].freedom == BaseFreedom::Turning) guide = BaseGuide::Point;
    }
    statics.trial = build_torsion_state(model);
    return statics;
}

void update_coordinate_accelerations(const TorsionModel& model, const TorsionState& state,
                                     AssemblyState& assembly, Coordinates& accelerations) noexcept {
    guide_pivots(model, state, assembly);
    update_accelerations(model.tree, state.positions, state.forces, assembly);
    read_accelerations(model, assembly, accelerations);
}

void multiply_by_inverse_mass(const TorsionModel& model, const TorsionState& state,
                              const Coordinates& coordinate_forces, AssemblyState& assembly,
                              Coordinates& accelerations) noexcept {
    guide_pivots(model, state, assembly);
    update_bodies(model.tree, state.positions, state.forces, assembly);
    put_on_bodies(model, state, coordinate_forces, assembly);
    upward_pass(model.tree, assembly);
    downward_pass(model.tree, assembly);
    read_accelerations(model, assembly, accelerations);
}

double find_largest_move(const std::vector<Vec3>& from, const std::vector<Vec3>& to) noexcept {
    double largest2 = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        largest2 = std::max(largest2, (to[i] - from[i]).squaredNorm());
    }
    return std::sqrt(largest2);
}

double find_largest_move(std::span<const std::uint32_t> atoms, const std::vector<Vec3>& from,
                         const std::vector<Vec3>& to) noexcept {
    double largest2 = 0;
    for (const std::uint32_t i : atoms)
        largest2 = std::max(largest2, (to[i] - from[i]).squaredNorm());
    return std::sqrt(largest2);
}

double place_within(const TorsionModel& model, const TorsionState& from, double largest_move,
                    Coordinates& move, TorsionState& trial) noexcept {
    // A joint that turns by more than that leaves the range in which atoms go straight.
    const double widest = move.size() == 0 ? 0 : move.cwiseAbs().maxCoeff();
    if (widest > 0.5) move *= 0.5 / widest;
    constexpr int tries = 30;
    for (int i = 0;; ++i) {
        copy_coordinates(from, trial);
        add_move(model, move, trial);
        const double far = find_largest_move(from.positions, trial.positions);
        if (!(far > largest_move)) return far;
        move *= i < tries ? 0.999 * largest_move / far : 0.0;
    }
}

bool is_lower(const ForceSettings& settings, const TorsionState& from, const TorsionState& to,
              const Coordinates& move) noexcept {
    return is_energy_lower(settings, sum_of_terms(from), to.energy() - from.energy(), [&] {
        return (from.coordinate_forces + to.coordinate_forces).dot(move);
    });
}

QuasiStaticReport step_quasi_static(const TorsionModel& model, const QuasiStaticSettings& settings,
                                    TorsionState& state, QuasiStatics& statics) {
    if (statics.h == 0) statics.h = settings.first_h;
    update_coordinate_accelerations(model, state, statics.assembly, statics.move);
    QuasiStaticReport report;
    report.is_finite = statics.move.allFinite();
    if (!report.is_finite) return report;
    statics.move *= 0.5 * statics.h * statics.h;
    const double wanted = statics.move.norm();
    report.largest_move =
        place_within(model, state, settings.largest_move, statics.move, statics.trial);
    report.is_bounded = statics.move.norm() < wanted;

    update_forces(model, settings.forces, statics.memory, statics.trial);
    if (settings.forces.fast) {
        update_coordinate_forces(model, state);
        update_coordinate_forces(model, statics.trial);
    }
    report.energy_change = statics.trial.energy() - state.energy();
    report.is_taken = std::isfinite(report.energy_change) &&
                      is_lower(settings.forces, state, statics.trial, statics.move);
    if (report.is_bounded) statics.h *= std::sqrt(statics.move.norm() / wanted);
    if (!report.is_taken) {
        statics.h *= settings.shrinkage;
        return report;
    }
    if (wanted > 0) statics.h = std::min(longest_h, settings.growth * statics.h);
    take_over(statics.trial, state);
    return report;
}

}  // namespace palpa
