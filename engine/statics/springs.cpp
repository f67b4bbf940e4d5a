#include "statics/springs.h"

namespace palpa {

Vec3 find_centre_of_mass(const TorsionModel& model, std::span<const std::uint32_t> atoms,
                         std::span<const Vec3> positions) noexcept {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (const std::uint32_t atom : atoms) {
        sum += model.masses[atom] * positions[atom];
        mass += model.masses[atom];
    }
    return sum / mass;
}

Vec3 find_other_end(const TorsionModel& model, const ModelSpring& spring,
                    std::span<const Vec3> positions) noexcept {
    if (spring.other_atoms.empty()) return spring.place;
    return find_centre_of_mass(model, spring.other_atoms, positions);
}

SpringPull find_spring_pull(const TorsionModel& model, const ModelSpring& spring,
                            std::span<const Vec3> positions) noexcept {
    const Vec3 stretch = find_centre_of_mass(model, spring.atoms, positions) -
                         find_other_end(model, spring, positions);
    if (spring.length == 0) return {stretch, spring.k, 0.5 * spring.k * stretch.squaredNorm()};
    const double distance = stretch.norm(), longer = distance - spring.length;
    const double k = distance > 0 ? spring.k * longer / distance : 0;
    return {stretch, k, 0.5 * spring.k * longer * longer};
}

Vec3 find_spring_force(const TorsionModel& model, const ModelSpring& spring,
                       std::span<const Vec3> positions) noexcept {
    const SpringPull pull = find_spring_pull(model, spring, positions);
    return pull.k * pull.stretch;
}

Mat3 find_spring_stiffness(const TorsionModel& model, const ModelSpring& spring,
                           std::span<const Vec3> positions) noexcept {
    const SpringPull pull = find_spring_pull(model, spring, positions);
    if (spring.length == 0) return spring.k * Mat3::Identity();
    const double distance = pull.stretch.norm();
    if (!(distance > 0)) return Mat3::Zero();
    const Vec3 along = pull.stretch / distance;
    return pull.k * Mat3::Identity() + (spring.k - pull.k) * along * along.transpose();
}

double add_spring_forces(const TorsionModel& model, const ModelSpring& spring,
                         std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    const SpringPull pull = find_spring_pull(model, spring, positions);
    visit_pulled(model, spring, [&](std::uint32_t atom, double share) {
        forces[atom] -= share * pull.k * pull.stretch;
    });
    return pull.energy;
}

}  // namespace palpa
