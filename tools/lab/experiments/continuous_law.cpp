#include "tools/lab/experiments/continuous_law.h"

#include "core/units.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

constexpr double newton = units::newton_per_kcal_per_mol_angstrom;
constexpr double newton_per_metre = units::newton_per_metre_per_kcal_per_mol_angstrom2;

const Grip& first_grip(const World& world) noexcept { return grip_of(world, hand_at(world, 0)); }

}  // namespace

ContinuousLaw::ContinuousLaw(GuardedSettings settings, World world)
    : settings_(std::move(settings)), world_(std::move(world)) {
    farthest_ = pose().place_angstrom.norm();
}

MoleculePose ContinuousLaw::pose() const noexcept { return first_grip(world_).pose; }

ContinuousLaw::Here ContinuousLaw::find_here() const {
    const FieldSum field = field_on_grabbed(world_);
    const Mat3& free = first_grip(world_).projector;
    const Vec3 force = newton * (free * field.force);
    const Mat3 stiffness = newton_per_metre * (free * field.stiffness * free);
    return {hand_force(settings_.force_law, force),
            guarded_gain(settings_, force, stiffness).inverse * free};
}

void ContinuousLaw::follow(const HandleStep& handle) {
    constexpr double longest = 0.01;  // Å
    const Vec3 turn = rotation_vector_of(handle.turned);
    const bool turns = first_grip(world_).freedom == 6;
    const Here before = find_here();
    const Vec3 way = units::angstrom_per_metre * before.metre_per_metre * handle.moved_m;
    const auto steps = std::max(1, static_cast<int>(std::ceil(way.norm() / longest)));
    for (int i = 0; i < steps; ++i) {
        const Here start = i == 0 ? before : find_here();
        const MoleculePose from = pose();
        const Vec3 moved_m = handle.moved_m / steps;
        const auto go = [&](const Here& by, double share) {
            const Quat turned = turns ? turn_of(share / steps * turn) : Quat::Identity();
            place_grabbed(world_,
                          MoleculePose{from.place_angstrom + share * units::angstrom_per_metre *
                                                                 (by.metre_per_metre * moved_m),
                                       (turned * from.orientation).normalized()});
        };
        go(start, 0.5);
        const Here middle = find_here();
        go(middle, 1);
        work_J_ += middle.hand_newton.dot(moved_m);
    }
    farthest_ = std::max(farthest_, pose().place_angstrom.norm());
}

double ContinuousLaw::felt_stiffness(const MoleculePose& place, const Mat3& molecule_per_handle) {
    const MoleculePose own = pose();
    place_grabbed(world_, place);
    const FieldSum field = field_on_grabbed(world_);
    place_grabbed(world_, own);
    const Mat3& free = first_grip(world_).projector;
    const Mat3 stiffness = newton_per_metre * (free * field.stiffness * free);
    return largest_felt(force_jacobian(settings_.force_law, newton * (free * field.force)) *
                        stiffness * molecule_per_handle);
}

}  // namespace palpa
