// Backbones of proteins with the same torsions at every residue.
#pragma once
#include "molecule/secondary_structure.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace palpa::test {

// The place at a distance from c, an angle from b and a dihedral from a.
inline Vec3 place_from(const Vec3& a, const Vec3& b, const Vec3& c, double length, double angle_deg,
                       double dihedral_deg) {
    constexpr double radian = std::numbers::pi / 180;
    const double angle = angle_deg * radian, dihedral = dihedral_deg * radian;
    const Vec3 x = (c - b).normalized();
    const Vec3 z = (b - a).cross(x).normalized();
    const Vec3 y = z.cross(x);
    return c + length * (-std::cos(angle) * x + std::sin(angle) * std::cos(dihedral) * y +
                         std::sin(angle) * std::sin(dihedral) * z);
}

// Of one residue or more, in degrees, with the bonds and angles of R. A. Engh, R. Huber, Acta
// Cryst. A 47, 392 (1991).
inline std::vector<BackboneResidue> build_chain(std::size_t count, double phi, double psi) {
    std::vector<BackboneResidue> chain(count);
    chain[0].n = {0, 0, 0};
    chain[0].alpha = {1.458, 0, 0};
    chain[0].c = place_from({0, 1, 0}, chain[0].n, chain[0].alpha, 1.525, 111.2, 60);
    for (std::size_t i = 0; i < count; ++i) {
        BackboneResidue& here = chain[i];
        here.o = place_from(here.n, here.alpha, here.c, 1.231, 120.8, psi + 180);
        if (i + 1 == count) break;
        BackboneResidue& next = chain[i + 1];
        next.follows = true;
        next.n = place_from(here.n, here.alpha, here.c, 1.329, 116.2, psi);
        next.alpha = place_from(here.alpha, here.c, next.n, 1.458, 121.7, 180);
        next.c = place_from(here.c, next.n, next.alpha, 1.525, 111.2, phi);
    }
    return chain;
}

}  // namespace palpa::test
