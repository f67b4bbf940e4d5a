// The dihedral angle of four atoms, and how it changes with their positions.
#pragma once
#include "math/vec.h"

#include <array>

namespace palpa {

struct Torsion {
    double angle;                  // rad, -pi to pi
    std::array<Vec3, 4> gradient;  // d(angle)/d(position), rad/Å
};

// Angle by the convention of IUPAC and CHARMM: 0 when a and d eclipse each other, positive when,
// looking from b to c, d stands clockwise of a.
// Source: A. Blondel, M. Karplus, J. Comput. Chem. 17, 1132 (1996), whose form divides by nothing
// but the bond b-c and the two planes' normals. Where three atoms stand in line a normal vanishes
// and the angle means nothing: the gradient grows without bound on the way there. Normals (cross
// products of two bonds) shorter than `torsion_guard` Å^2 scale it down to zero, so that it stays
// bounded; it still sums up to no force and no torque. The angle is finite whatever the positions.
Torsion evaluate_torsion(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

// 0.13 degree off the line for bonds of 1.5 Å; where CHARMM stops evaluating a dihedral (RXMIN).
inline constexpr double torsion_guard = 0.005;

}  // namespace palpa
