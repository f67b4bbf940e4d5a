#include "statics/local_coordinates.h"

#include "core/assertion.h"
#include "core/repeatable.h"

#include <cmath>
#include <utility>

namespace palpa {
namespace {

// The columns of a base's turns and displacements; -1 for what it has none of.
struct BaseColumns {
    Eigen::Index turn = -1, shift = -1;
};

std::vector<BaseColumns> find_base_columns(const TorsionModel& model,
                                           std::span<const HandHold> hands,
                                           LocalCoordinates& coordinates) {
    std::vector<BaseColumns> columns(model.bases.size());
    for (std::size_t m = 0; m < columns.size(); ++m) {
        columns[m].turn = model.coordinate_of_base[m];
        if (model.bases[m].freedom == BaseFreedom::Free) columns[m].shift = columns[m].turn + 3;
    }
    for (const HandHold& hand : hands) {
        const auto take_three = [&] {
            coordinates.hands += 3;
            return coordinates.size() - 3;
        };
        if (hand.spring) {
            coordinates.ends.push_back({*hand.spring, take_three()});
            continue;
        }
        BaseColumns& base = columns[hand.molecule];
        PALPA_ASSERT(base.shift < 0 && !(hand.turns && base.turn >= 0));
        if (hand.turns) base.turn = take_three();
        base.shift = take_three();
    }
    return columns;
}

void add_three(Eigen::Index column, CoordinateKind kind, std::vector<CarriedCoordinate>& carried) {
    if (column < 0) return;
    for (int axis = 0; axis < 3; ++axis) carried.push_back({column + axis, kind, axis});
}

void order_bodies(std::span<const Body> bodies, LocalCoordinates& coordinates) {
    const auto count = static_cast<std::uint32_t>(bodies.size());
    std::vector<std::uint32_t> behind(count, 1);  // the body itself too
    for (std::uint32_t b = count; b-- > 0;) {
        if (bodies[b].parent != no_body) behind[bodies[b].parent] += behind[b];
    }
    std::vector<std::uint32_t> next(count);  // where the next child of each body enters
    std::uint32_t next_base = 0;
    coordinates.entered.resize(count);
    coordinates.left.resize(count);
    for (std::uint32_t b = 0; b < count; ++b) {
        std::uint32_t& place = bodies[b].parent == no_body ? next_base : next[bodies[b].parent];
        coordinates.entered[b] = place;
        place += behind[b];
        coordinates.left[b] = place;
        next[b] = coordinates.entered[b] + 1;
    }
}

// How the axis of a turn that is added to a rotation vector stands in the world: a small change d
// of the vector v turns by J(v) d. (The left Jacobian of the rotation group, see J. Solà et al.,
// arXiv:1812.01537, eq. 145.)
Mat3 left_jacobian(const Vec3& rotation_vector) noexcept {
    const double angle2 = rotation_vector.squaredNorm(), angle = std::sqrt(angle2);
    const Mat3 cross = cross_matrix(rotation_vector);
    double first = 0.5 - angle2 / 24, second = 1.0 / 6 - angle2 / 120;
    constexpr double small = 1e-3;  // rad, below which the next terms of the series are rounding
    if (angle > small) {
        first = (1 - repeatable::cos(angle)) / angle2;
        second = (angle - repeatable::sin(angle)) / (angle2 * angle);
    }
    return Mat3::Identity() + first * cross + second * cross * cross;
}

Vec3 three_at(const Eigen::VectorXd& at, const CarriedCoordinate& first) {
    return at.segment<3>(first.column);
}

}  // namespace

LocalCoordinates build_local_coordinates(const TorsionModel& model,
                                         std::span<const HandHold> hands) {
    LocalCoordinates coordinates;
    coordinates.mobile = model.coordinates;
    const std::vector<BaseColumns> bases = find_base_columns(model, hands, coordinates);
    const std::span<const Body> bodies = model.tree.bodies.bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        coordinates.first.push_back(coordinates.carried.size());
        if (model.tree.bodies.is_base(b)) {
            const BaseColumns& base = bases[model.tree.molecule_of[b]];
            add_three(base.turn, CoordinateKind::Turn, coordinates.carried);
            add_three(base.shift, CoordinateKind::Shift, coordinates.carried);
        } else {
            coordinates.carried.push_back({model.coordinate_of_body[b], CoordinateKind::Joint, -1});
        }
    }
    coordinates.first.push_back(coordinates.carried.size());
    order_bodies(bodies, coordinates);
    return coordinates;
}

void update_motions(const TorsionModel& model, const LocalCoordinates& coordinates,
                    const TorsionState& state, std::vector<CoordinateMotion>& motions) {
    motions.assign(static_cast<std::size_t>(coordinates.size()), {});
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        for (const CarriedCoordinate& carried : coordinates.of(b)) {
            CoordinateMotion& motion = motions[static_cast<std::size_t>(carried.column)];
            if (carried.kind == CoordinateKind::Joint) {
                const auto [j, k] = bodies[b].axis;
                motion.axis = (state.positions[k] - state.positions[j]).normalized();
                motion.point = state.positions[k];
            } else if (carried.kind == CoordinateKind::Turn) {
                motion.axis = Vec3::Unit(carried.axis);
                motion.point = state.pivots[model.tree.molecule_of[b]];
            } else {
                motion.shift = Vec3::Unit(carried.axis);
            }
        }
    }
}

void place_about(const TorsionModel& model, const LocalCoordinates& coordinates,
                 const TorsionState& origin, const Eigen::VectorXd& at, TorsionState& state) {
    PALPA_ASSERT(at.size() == coordinates.size());
    const std::vector<Quat> turns = std::exchange(state.turns, origin.turns);
    const std::vector<Vec3> shifts = std::exchange(state.shifts, origin.shifts);
    state.springs = origin.springs;
    std::vector<std::uint8_t> is_changed(model.bases.size(), 0);
    for (std::size_t b = 0; b < model.tree.bodies.bodies.size(); ++b) {
        const std::uint32_t m = model.tree.molecule_of[b];
        double angle = origin.angles[b];
        for (const CarriedCoordinate& carried : coordinates.of(b)) {
            if (carried.kind == CoordinateKind::Joint) angle += at[carried.column];
            if (carried.axis != 0) continue;  // of three at a time
            if (carried.kind == CoordinateKind::Turn) {
                const Quat turn = turn_of(three_at(at, carried));
                state.turns[m] = (turn * origin.turns[m]).normalized();
                state.shifts[m] = origin.pivots[m] + turn * (origin.shifts[m] - origin.pivots[m]);
            } else {
                state.shifts[m] += three_at(at, carried);
            }
        }
        if (std::exchange(state.angles[b], angle) != angle) is_changed[m] = 1;
    }
    for (const LocalCoordinates::SpringEnd& end : coordinates.ends) {
        state.springs[end.spring].place += at.segment<3>(end.column);
    }
    for (std::size_t m = 0; m < is_changed.size(); ++m) {
        if (turns[m].coeffs() != state.turns[m].coeffs() || shifts[m] != state.shifts[m])
            is_changed[m] = 1;
    }
    update_positions(model, is_changed, state);
}

Eigen::VectorXd find_gradient(const TorsionModel& model, const LocalCoordinates& coordinates,
                              const TorsionState& origin, const Eigen::VectorXd& at,
                              TorsionState& state) {
    update_coordinate_forces(model, state);
    Eigen::VectorXd gradient(coordinates.size());
    for (std::size_t b = 0; b < model.tree.bodies.bodies.size(); ++b) {
        const std::span<const CarriedCoordinate> of_body = coordinates.of(b);
        Vec3 pivot = origin.pivots[model.tree.molecule_of[b]];
        for (const CarriedCoordinate& carried : of_body) {
            if (carried.kind == CoordinateKind::Shift && carried.axis == 0)
                pivot += three_at(at, carried);
        }
        for (const CarriedCoordinate& carried : of_body) {
            const Vec6& wrench = state.wrenches[b];
            if (carried.kind == CoordinateKind::Joint) {
                gradient[carried.column] = -state.coordinate_forces[carried.column];
            } else if (carried.kind == CoordinateKind::Shift) {
                gradient[carried.column] = -wrench[3 + carried.axis];
            } else if (carried.axis == 0) {
                const Vec3 torque = wrench.head<3>() - pivot.cross(wrench.tail<3>());
                gradient.segment<3>(carried.column) =
                    -(left_jacobian(three_at(at, carried)).transpose() * torque);
            }
        }
    }
    for (const LocalCoordinates::SpringEnd& end : coordinates.ends) {
        gradient.segment<3>(end.column) =
            -find_spring_force(model, state.springs[end.spring], state.positions);
    }
    return gradient;
}

}  // namespace palpa
