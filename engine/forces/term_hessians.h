// Second derivatives of the bonded terms' energies, in double.
//
// A term's energy depends on the vectors between its atoms alone: u and v from the middle of an
// angle to its ends; F, G and H of a dihedral (forces/torsion.cpp). Each function returns what it
// does along these vectors, one below the other; Shares says how they go with the atoms.
#pragma once
#include "charmm/topology.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <span>

namespace palpa {

// Gradient (kcal/mol/Å) and Hessian (kcal/mol/Å^2) of an energy with respect to some vectors.
template <int Vectors>
struct TermHessian {
    Eigen::Matrix<double, 3 * Vectors, 1> gradient = decltype(gradient)::Zero();
    Eigen::Matrix<double, 3 * Vectors, 3 * Vectors> hessian = decltype(hessian)::Zero();
};

// The contribution of each atom's position to each vector.
template <std::size_t Vectors, std::size_t Atoms>
using Shares = std::array<std::array<double, Atoms>, Vectors>;

inline constexpr Shares<1, 2> spring_shares{{{1, -1}}};
inline constexpr Shares<2, 3> angle_shares{{{1, -1, 0}, {0, -1, 1}}};
inline constexpr Shares<3, 4> torsion_shares{{{1, -1, 0, 0}, {0, 1, -1, 0}, {0, 0, -1, 1}}};

// k (|d| - r0)^2. Zero for two atoms at the same place, as for forces.
TermHessian<1> find_spring_hessian(double k, double r0, const Vec3& d) noexcept;

// Zero for three collinear atoms, as for forces.
TermHessian<2> find_angle_hessian(const Angle& angle, const Vec3& u, const Vec3& v) noexcept;

// A dihedral angle and its derivatives; of_energy gives those of an energy over the angle from the
// energy's first and second derivative. Where three atoms stand in line (forces/torsion.h) the
// Hessian is scaled down like the gradient, and stays bounded.
struct TorsionHessian {
    double angle;                         // rad
    Eigen::Matrix<double, 9, 1> slope;    // d(angle)/d(F, G, H), rad/Å
    Eigen::Matrix<double, 9, 9> hessian;  // rad/Å^2

    TermHessian<3> of_energy(double first, double second) const noexcept;
};
TorsionHessian find_torsion_hessian(const Vec3& F, const Vec3& G, const Vec3& H) noexcept;

// E = k (1 + cos(n phi - phase)) and E = k (psi - psi0)^2: first and second derivative.
struct Slopes {
    double first = 0, second = 0;
};
Slopes find_slopes(const Dihedral& dihedral, double angle) noexcept;
Slopes find_slopes(const Improper& improper, double angle) noexcept;

// The surface's derivatives (kcal/mol/rad and kcal/mol/rad^2) at two angles (rad, -pi to pi). The
// second ones jump at the lines of the grid.
struct CmapSlopes {
    double phi, psi, phi_phi, phi_psi, psi_psi;
};
CmapSlopes find_cmap_slopes(const CmapMap& map, double phi, double psi) noexcept;

}  // namespace palpa
