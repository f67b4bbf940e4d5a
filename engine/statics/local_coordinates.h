// Coordinates about a point of linearisation, including those of hands. The energy as a function of
// them has a gradient and a Hessian.
#pragma once
#include "statics/torsion_state.h"

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// What a hand moves: the position of a base that is not free, and, if the hand turns a held base,
// its rotation about its pivot; or the end of one of the state's springs.
struct HandHold {
    std::uint32_t molecule = 0;
    bool turns = false;
    std::optional<std::size_t> spring = {};
};

enum class CoordinateKind : std::uint8_t { Joint, Turn, Shift };

struct CarriedCoordinate {
    Eigen::Index column;
    CoordinateKind kind;
    int axis;  // axis of the world, 0, 1 or 2; -1 for a joint
};

// First the mobile coordinates of the model, in its order; then those of hands, in theirs: three
// turns if the hand turns what it holds, and three displacements.
//
// Positions are functions of them, all 0 at the point of linearisation: joint angles are added; a
// base turns by the rotation vector about where its pivot was there, then is displaced. (add_move
// composes turns about the pivots of the moment instead, which is no function of their sum.)
struct LocalCoordinates {
    Eigen::Index mobile = 0, hands = 0;

    // The coordinates of body b are [first[b], first[b + 1]), turns before displacements.
    std::vector<std::size_t> first;
    std::vector<CarriedCoordinate> carried;

    struct SpringEnd {
        std::size_t spring;
        Eigen::Index column;  // index of the first of three
    };
    std::vector<SpringEnd> ends;

    // Bodies ordered so that all descendants of body b lie in [entered[b], left[b]).
    std::vector<std::uint32_t> entered, left;

    Eigen::Index size() const noexcept { return mobile + hands; }
    std::span<const CarriedCoordinate> of(std::size_t body) const noexcept {
        return std::span(carried).subspan(first[body], first[body + 1] - first[body]);
    }
    // True if `other` is the body itself or one of its descendants.
    bool carries(std::uint32_t body, std::uint32_t other) const noexcept {
        return entered[body] <= entered[other] && entered[other] < left[body];
    }
};

LocalCoordinates build_local_coordinates(const TorsionModel& model,
                                         std::span<const HandHold> hands = {});

// How atoms move with a coordinate: rotation about a point, or a common translation.
struct CoordinateMotion {
    Vec3 axis = Vec3::Zero();   // of length 1, or zero
    Vec3 point = Vec3::Zero();  // a point on the axis, Å
    Vec3 shift = Vec3::Zero();  // of length 1, or zero

    Vec3 velocity_at(const Vec3& place) const noexcept { return axis.cross(place - point) + shift; }
    // Angular velocity, and velocity at this position.
    Vec6 screw_at(const Vec3& place) const noexcept {
        Vec6 screw;
        screw << axis, velocity_at(place);
        return screw;
    }
};

// Computes the motion for each coordinate at a state taken as point of linearisation. The end of a
// spring moves no atom.
void update_motions(const TorsionModel& model, const LocalCoordinates& coordinates,
                    const TorsionState& state, std::vector<CoordinateMotion>& motions);

// Moves `state`, a state of this model, to the coordinates counted from `origin`.
void place_about(const TorsionModel& model, const LocalCoordinates& coordinates,
                 const TorsionState& origin, const Eigen::VectorXd& at, TorsionState& state);

// The gradient of the energy along the coordinates at the state set by place_about, from the forces
// on its atoms; also updates its coordinate forces.
Eigen::VectorXd find_gradient(const TorsionModel& model, const LocalCoordinates& coordinates,
                              const TorsionState& origin, const Eigen::VectorXd& at,
                              TorsionState& state);

}  // namespace palpa
