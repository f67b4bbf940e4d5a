// Energies and forces of bonds, angles, Urey-Bradley springs, dihedrals and impropers.
#pragma once
#include "charmm/topology.h"
#include "math/vec.h"

#include <span>

namespace palpa {

// Each adds the forces of its terms (kcal/mol/Å) to `forces`, one entry per atom, and returns their
// energy (kcal/mol), summed in the order of the terms. The functional forms stand in
// charmm/topology.h. Every term's forces sum up to no force and no torque, and stay finite wherever
// the atoms are, as said at each.

// Two atoms at the same place have no direction of force: the force is 0.
double add_bond_forces(std::span<const Bond> bonds, std::span<const Vec3> positions,
                       std::span<Vec3> forces) noexcept;
double add_urey_bradley_forces(std::span<const UreyBradley> terms, std::span<const Vec3> positions,
                               std::span<Vec3> forces) noexcept;

// Three atoms in line (a sine below 1e-10) have no plane to bend in: no force, which is also what a
// straight theta0 asks for. The same where two neighbours of an angle lie within 1e-10 Å.
double add_angle_forces(std::span<const Angle> angles, std::span<const Vec3> positions,
                        std::span<Vec3> forces) noexcept;

// For three atoms of a dihedral in line see forces/torsion.h. An improper turned to exactly
// psi0 + pi is pushed back one of the two ways.
double add_dihedral_forces(std::span<const Dihedral> dihedrals, std::span<const Vec3> positions,
                           std::span<Vec3> forces) noexcept;
double add_improper_forces(std::span<const Improper> impropers, std::span<const Vec3> positions,
                           std::span<Vec3> forces) noexcept;

}  // namespace palpa
