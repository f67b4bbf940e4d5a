#include "forces/bonded.h"

#include "core/repeatable.h"
#include "forces/torsion.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace palpa {
namespace {

// E = k (r - r0)^2 between two atoms.
double add_spring(std::uint32_t a, std::uint32_t b, double k, double r0,
                  std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    const Vec3 d = positions[a] - positions[b];
    const double r = d.norm();
    const double stretch = r - r0;
    if (r > 0) {
        const Vec3 force = (-2.0 * k * stretch / r) * d;
        forces[a] += force;
        forces[b] -= force;
    }
    return k * stretch * stretch;
}

// Forces of an energy with this slope (kcal/mol/rad) over the dihedral angle of a term's atoms.
template <class Term>
void add_torsion_forces(const Term& term, const Torsion& torsion, double slope,
                        std::span<Vec3> forces) noexcept {
    forces[term.a] -= slope * torsion.gradient[0];
    forces[term.b] -= slope * torsion.gradient[1];
    forces[term.c] -= slope * torsion.gradient[2];
    forces[term.d] -= slope * torsion.gradient[3];
}

template <class Term>
Torsion evaluate_torsion(const Term& term, std::span<const Vec3> positions) noexcept {
    return palpa::evaluate_torsion(positions[term.a], positions[term.b], positions[term.c],
                                   positions[term.d]);
}

}  // namespace

double add_bond_forces(std::span<const Bond> bonds, std::span<const Vec3> positions,
                       std::span<Vec3> forces) noexcept {
    double energy = 0;
    for (const Bond& bond : bonds) {
        energy += add_spring(bond.a, bond.b, bond.k, bond.r0, positions, forces);
    }
    return energy;
}

double add_urey_bradley_forces(std::span<const UreyBradley> terms, std::span<const Vec3> positions,
                               std::span<Vec3> forces) noexcept {
    double energy = 0;
    for (const UreyBradley& term : terms) {
        energy += add_spring(term.a, term.c, term.k, term.s0, positions, forces);
    }
    return energy;
}

double add_angle_forces(std::span<const Angle> angles, std::span<const Vec3> positions,
                        std::span<Vec3> forces) noexcept {
    constexpr double in_line = 1e-10;   // sine below which the normal is rounding noise
    constexpr double shortest = 1e-10;  // Å
    double energy = 0;
    for (const Angle& angle : angles) {
        const Vec3 u = positions[angle.a] - positions[angle.b];
        const Vec3 v = positions[angle.c] - positions[angle.b];
        const Vec3 normal = u.cross(v);
        const double sine = normal.norm();  // times |u| |v|
        const double bend = repeatable::atan2(sine, u.dot(v)) - angle.theta0;
        energy += angle.k * bend * bend;
        const double u2 = u.squaredNorm(), v2 = v.squaredNorm();
        if (!(u2 > shortest * shortest && v2 > shortest * shortest &&
              sine > in_line * std::sqrt(u2 * v2)))
            continue;

        // The angle opens as a moves along u x n and c along n x v, n the unit normal.
        const double force = 2.0 * angle.k * bend / sine;
        const Vec3 on_a = (-force / u2) * u.cross(normal);
        const Vec3 on_c = (-force / v2) * normal.cross(v);
        forces[angle.a] += on_a;
        forces[angle.b] -= on_a + on_c;
        forces[angle.c] += on_c;
    }
    return energy;
}

double add_dihedral_forces(std::span<const Dihedral> dihedrals, std::span<const Vec3> positions,
                           std::span<Vec3> forces) noexcept {
    double energy = 0;
    for (const Dihedral& dihedral : dihedrals) {
        const Torsion torsion = evaluate_torsion(dihedral, positions);
        const double x = dihedral.multiplicity * torsion.angle - dihedral.phase;
        energy += dihedral.k * (1.0 + repeatable::cos(x));
        const double slope = -dihedral.k * dihedral.multiplicity * repeatable::sin(x);
        add_torsion_forces(dihedral, torsion, slope, forces);
    }
    return energy;
}

double add_improper_forces(std::span<const Improper> impropers, std::span<const Vec3> positions,
                           std::span<Vec3> forces) noexcept {
    double energy = 0;
    for (const Improper& improper : impropers) {
        const Torsion torsion = evaluate_torsion(improper, positions);
        const double bend = std::remainder(torsion.angle - improper.psi0, 2.0 * std::numbers::pi);
        energy += improper.k * bend * bend;
        add_torsion_forces(improper, torsion, 2.0 * improper.k * bend, forces);
    }
    return energy;
}

}  // namespace palpa
