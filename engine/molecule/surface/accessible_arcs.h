// The places that the centre of a rolling probe can reach while it touches two or three atoms.
#pragma once
#include "molecule/ball_grid.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace palpa {

// Grows with the angle from x towards y as an angle does, from 0 to 4 in a whole turn: what of the
// perimeter of a square is gone by. Cheaper than the angle.
inline double square_angle(double x, double y) noexcept {
    const double across = x / (std::abs(x) + std::abs(y));
    return y >= 0 ? 1 - across : 3 + across;
}

// A part of the circle in which the spheres of two balls meet, inside of no third ball. From square
// angle `from` to `to` (to > from), counted from `x` towards `y`; a whole circle where they are 4
// apart.
struct AccessibleArc {
    Vec3 centre{0, 0, 0};                        // Å
    Vec3 axis{0, 0, 1}, x{1, 0, 0}, y{0, 1, 0};  // unit vectors, right-handed x, y, axis
    double radius = 0;                           // Å
    double from = 0, to = 0;
    std::array<Vec3, 2> ends{Vec3::Zero(), Vec3::Zero()};
};

// Arcs on the sphere of a ball with those balls that come after it by number of atom. `balls` has
// all balls whose spheres may meet it, radii with the probe's.
void find_accessible_arcs(const AtomBall& ball, std::span<const AtomBall> balls,
                          std::vector<AccessibleArc>& arcs);

// The point of an arc that is nearest to a place, where it is closer than `distance`; updates both.
void find_nearest_on_arc(const AccessibleArc& arc, const Vec3& place, double& distance,
                         Vec3& nearest) noexcept;

}  // namespace palpa
