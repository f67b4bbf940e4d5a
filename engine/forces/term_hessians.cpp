#include "forces/term_hessians.h"

#include "core/repeatable.h"
#include "forces/torsion.h"
#include "math/spatial.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa {
namespace {

// Without what is along a direction of length 1; and with that turned round.
Mat3 across(const Vec3& direction) noexcept {
    return Mat3::Identity() - direction * direction.transpose();
}
Mat3 mirrored(const Vec3& direction) noexcept {
    return Mat3::Identity() - 2 * direction * direction.transpose();
}

// Weights of a cubic Hermite polynomial at t in [0, 1]: of the values at both ends, then of the
// slopes; and their derivatives.
using HermiteWeights = std::array<double, 4>;
struct HermiteJet {
    HermiteWeights value, first, second;
};
HermiteJet evaluate_hermite(double t) noexcept {
    const double s = 1 - t;
    return {{s * s * (1 + 2 * t), t * t * (3 - 2 * t), s * s * t, -t * t * s},
            {-6 * s * t, 6 * s * t, s * (1 - 3 * t), t * (3 * t - 2)},
            {12 * t - 6, 6 - 12 * t, 6 * t - 4, 6 * t - 2}};
}

struct CmapCell {
    std::array<std::size_t, 2> points;
    HermiteJet weights;
};
CmapCell find_cmap_cell(double angle, std::size_t size) noexcept {
    const double place = (angle / (2 * std::numbers::pi) + 0.5) * static_cast<double>(size);
    const std::size_t low = place > 0 ? std::min(static_cast<std::size_t>(place), size - 1) : 0;
    return {{low, (low + 1) % size}, evaluate_hermite(place - static_cast<double>(low))};
}

}  // namespace

TermHessian<1> find_spring_hessian(double k, double r0, const Vec3& d) noexcept {
    TermHessian<1> result;
    const double r = d.norm();
    if (!(r > 0)) return result;
    const Vec3 along = d / r;
    result.gradient = 2 * k * (r - r0) * along;
    result.hessian = 2 * k * (along * along.transpose() + (r - r0) / r * across(along));
    return result;
}

// With c and s the cosine and the sine of the angle, its gradient along u is
// p = (c u^ - v^)/(s |u|), q along v likewise; dc = -s (p du + q dv) gives their derivatives.
TermHessian<2> find_angle_hessian(const Angle& angle, const Vec3& u, const Vec3& v) noexcept {
    constexpr double in_line = 1e-10;   // sine
    constexpr double shortest = 1e-10;  // Å
    TermHessian<2> result;
    const double length_u = u.norm(), length_v = v.norm();
    if (!(length_u > shortest && length_v > shortest)) return result;
    const Vec3 along_u = u / length_u, along_v = v / length_v;
    const double c = along_u.dot(along_v), s = along_u.cross(along_v).norm();
    if (!(s > in_line)) return result;
    const Vec3 p = (c * along_u - along_v) / (s * length_u);
    const Vec3 q = (c * along_v - along_u) / (s * length_v);
    const auto bend = [&](const Vec3& along, double length, const Vec3& slope) -> Mat3 {
        const Mat3 mixed = along * slope.transpose();
        return (c / length * across(along) - s * (mixed + mixed.transpose()) -
                c * length * slope * slope.transpose()) /
               (s * length);
    };
    Eigen::Matrix<double, 6, 6> second;
    second.topLeftCorner<3, 3>() = bend(along_u, length_u, p);
    second.bottomRightCorner<3, 3>() = bend(along_v, length_v, q);
    second.topRightCorner<3, 3>() = -(s * along_u * q.transpose() + across(along_v) / length_v +
                                      c * length_u * p * q.transpose()) /
                                    (s * length_u);
    second.bottomLeftCorner<3, 3>() = second.topRightCorner<3, 3>().transpose();

    const double first = 2 * angle.k * (repeatable::atan2(s, c) - angle.theta0);
    Eigen::Matrix<double, 6, 1> slope;
    slope << p, q;
    result.gradient = first * slope;
    result.hessian = 2 * angle.k * slope * slope.transpose() + first * second;
    return result;
}

TermHessian<3> TorsionHessian::of_energy(double first, double second) const noexcept {
    TermHessian<3> result;
    result.gradient = first * slope;
    result.hessian = second * slope * slope.transpose() + first * hessian;
    return result;
}

// The gradients of forces/torsion.cpp, of_F = -L A/A^2, of_H = L B/B^2 with L = |G|, and
// of_G = -(F G/L^2) of_F - (H G/L^2) of_H, derived once more: d(A/A^2) = (1 - 2 a a^T) dA/A^2 with
// a the direction of A.
TorsionHessian find_torsion_hessian(const Vec3& F, const Vec3& G, const Vec3& H) noexcept {
    const Vec3 A = F.cross(G), B = H.cross(G);
    const double A_squared = A.squaredNorm(), B_squared = B.squaredNorm(),
                 L_squared = G.squaredNorm();
    const double L = std::sqrt(L_squared);
    TorsionHessian result{repeatable::atan2(L * H.dot(A), A.dot(B)), decltype(result.slope)::Zero(),
                          decltype(result.hessian)::Zero()};
    if (!(A_squared > 0 && B_squared > 0 && L > 0)) return result;
    constexpr double guard2 = torsion_guard * torsion_guard;
    const double scale = std::min({1.0, A_squared / guard2, B_squared / guard2});

    const Vec3 of_F = -L / A_squared * A, of_H = L / B_squared * B;
    const double along_F = F.dot(G) / L_squared, along_H = H.dot(G) / L_squared;
    const Mat3 turn_A = L / A_squared * mirrored(A / std::sqrt(A_squared));
    const Mat3 turn_B = L / B_squared * mirrored(B / std::sqrt(B_squared));
    const Vec3 direction = G / L;
    const Mat3 F_F = turn_A * cross_matrix(G), H_H = -turn_B * cross_matrix(G);
    const Mat3 F_G = -A * direction.transpose() / A_squared - turn_A * cross_matrix(F);
    const Mat3 H_G = B * direction.transpose() / B_squared + turn_B * cross_matrix(H);
    const Vec3 slope_F = F / L_squared - 2 * along_F * G / L_squared,
               slope_H = H / L_squared - 2 * along_H * G / L_squared;
    const Mat3 G_G =
        -of_F * slope_F.transpose() - along_F * F_G - of_H * slope_H.transpose() - along_H * H_G;

    result.slope << of_F, -along_F * of_F - along_H * of_H, of_H;
    result.hessian.block<3, 3>(0, 0) = F_F;
    result.hessian.block<3, 3>(0, 3) = F_G;
    result.hessian.block<3, 3>(3, 0) = F_G.transpose();
    result.hessian.block<3, 3>(3, 3) = G_G;
    result.hessian.block<3, 3>(3, 6) = H_G.transpose();
    result.hessian.block<3, 3>(6, 3) = H_G;
    result.hessian.block<3, 3>(6, 6) = H_H;
    result.slope *= scale;
    result.hessian *= scale;
    return result;
}

Slopes find_slopes(const Dihedral& dihedral, double angle) noexcept {
    const double n = dihedral.multiplicity, x = n * angle - dihedral.phase;
    return {-dihedral.k * n * repeatable::sin(x), -dihedral.k * n * n * repeatable::cos(x)};
}

Slopes find_slopes(const Improper& improper, double angle) noexcept {
    const double bend = std::remainder(angle - improper.psi0, 2 * std::numbers::pi);
    return {2 * improper.k * bend, 2 * improper.k};
}

CmapSlopes find_cmap_slopes(const CmapMap& map, double phi, double psi) noexcept {
    const CmapCell row = find_cmap_cell(phi, map.size), column = find_cmap_cell(psi, map.size);
    const auto sum = [&](const HermiteWeights& of_phi, const HermiteWeights& of_psi) {
        double result = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t j = 0; j < 2; ++j) {
                const CmapPoint& p = map.points[row.points[i] * map.size + column.points[j]];
                result += of_phi[i] * (of_psi[j] * p.energy + of_psi[j + 2] * p.slope_psi) +
                          of_phi[i + 2] * (of_psi[j] * p.slope_phi + of_psi[j + 2] * p.twist);
            }
        }
        return result;
    };
    const double per_rad = static_cast<double>(map.size) / (2 * std::numbers::pi);
    const HermiteJet &a = row.weights, &b = column.weights;
    return {per_rad * sum(a.first, b.value), per_rad * sum(a.value, b.first),
            per_rad * per_rad * sum(a.second, b.value), per_rad * per_rad * sum(a.first, b.first),
            per_rad * per_rad * sum(a.value, b.second)};
}

}  // namespace palpa
