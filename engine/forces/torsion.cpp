#include "forces/torsion.h"

#include "core/repeatable.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace palpa {

Torsion evaluate_torsion(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
    // The paper's letters: F, G, H the bonds, A and B the normals of the two planes.
    const Vec3 F = a - b, G = b - c, H = d - c;
    const Vec3 A = F.cross(G), B = H.cross(G);
    const double A_squared = A.squaredNorm(), B_squared = B.squaredNorm(), length = G.norm();

    Torsion torsion{repeatable::atan2(length * H.dot(A), A.dot(B)), {}};
    torsion.gradient.fill(Vec3::Zero());
    if (!(A_squared > 0 && B_squared > 0 && length > 0)) return torsion;

    // One factor for both planes keeps the torque about b-c at zero.
    constexpr double guard2 = torsion_guard * torsion_guard;
    const double scale = std::min({1.0, A_squared / guard2, B_squared / guard2});
    const Vec3 of_F = (-length * scale / A_squared) * A;
    const Vec3 of_H = (length * scale / B_squared) * B;
    const double length2 = length * length;
    const Vec3 of_G = -(F.dot(G) / length2) * of_F - (H.dot(G) / length2) * of_H;
    torsion.gradient = {of_F, of_G - of_F, -of_G - of_H, of_H};
    return torsion;
}

}  // namespace palpa
