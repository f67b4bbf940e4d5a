// Coordinates about a point of linearisation, those of hands too: numbers that say where everything
// is, of which an energy has a gradient and a Hessian.
#pragma once
#include "statics/torsion_state.h"

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// What a hand moves: the place of a base that is not free, and if the hand turns it (a held one)
// its turn about its pivot; or the place at the end of one of the state's springs.
struct HandHold {
    std::uint32_t molecule = 0;
    bool turns = false;
    std::optional<std::size_t> spring = {};
};

enum class CoordinateKind : std::uint8_t { Joint, Turn, Shift };

struct CarriedCoordinate {
    Eigen::Index column;
    CoordinateKind kind;
    int axis;  // of the world: 0, 1 or 2; of a joint -1
};

// First the mobile coordinates of the model, in its order; then those of hands, in theirs: three
// turns if the hand turns what it holds, and three displacements.
//
// Positions are functions of them, all 0 at the point of linearisation: joint angles are added; a
// base turns by the rotation vector about where its pivot was there, then is displaced. (add_move
// composes turns about the pivots of the moment instead, which is no function of their sum.)
struct LocalCoordinates {
    Eigen::Index mobile = 0, hands = 0;

    // Of body b: [first[b], first[b + 1]), turns before displacements.
    std::vector<std::size_t> first;
    std::vector<CarriedCoordinate> carried;

    struct SpringEnd {
        std::size_t spring;
        Eigen::Index column;  // of the first of three
    };
    std::vector<SpringEnd> ends;

    // Bodies in an order in which all that hang on body b stand in [entered[b], left[b]).
    std::vector<std::uint32_t> entered, left;

    Eigen::Index size() const noexcept { return mobile + hands; }
    std::span<const CarriedCoordinate> of(std::size_t body) const noexcept {
        return std::span(carried).subspan(first[body], first[body + 1] - first[body]);
    }
    // Whether `other` is the body itself or is attached to it.
    bool carries(std::uint32_t body, std::uint32_t other) const noexcept {
        return entered[body] <= entered[other] && entered[other] < left[body];
    }
};

LocalCoordinates build_local_coordinates(const TorsionModel& model,
                                         std::span<const HandHold> hands = {});

// How atoms move with a coordinate: they turn about a point, or go all alike.
struct CoordinateMotion {
    Vec3 axis = Vec3::Zero();   // of length 1, or zero
    Vec3 point = Vec3::Zero();  // on it, Å
    Vec3 shift = Vec3::Zero();  // of length 1, or zero

    Vec3 velocity_at(const Vec3& place) const noexcept { return axis.cross(place - point) + shift; }
    // Angular velocity, and velocity of the place.
    Vec6 screw_at(const Vec3& place) const noexcept {
        Vec6 screw;
        screw << axis, velocity_at(place);
        return screw;
    }
};

// Of each coordinate at a state that is taken as point of linearisation. That of a spring's end
// moves no atom.
void update_motions(const TorsionModel& model, const LocalCoordinates& coordinates,
                    const TorsionState& state, std::vector<CoordinateMotion>& motions);

// Puts `state`, one of this model, where the coordinates say that are counted from `origin`.
void place_about(const TorsionModel& model, const LocalCoordinates& coordinates,
                 const TorsionState& origin, const Eigen::VectorXd& at, TorsionState& state);

// The gradient of the energy along the coordinates where place_about put the state, from the forces
// on its atoms; its coordinate forces are written on the way.
Eigen::VectorXd find_gradient(const TorsionModel& model, const LocalCoordinates& coordinates,
                              const TorsionState& origin, const Eigen::VectorXd& at,
                              TorsionState& state);

}  // namespace palpa
