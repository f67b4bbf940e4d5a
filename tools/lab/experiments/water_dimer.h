// Finds the dimer of two rigid waters with the lowest energy.
#pragma once
#include "charmm/force_field.h"
#include "math/vec.h"

#include <vector>

namespace palpa {

// A rigid water of a force field.
struct RigidWater {
    double bond = 0;                                      // Å
    double angle = 0;                                     // rad
    std::vector<double> charge, sqrt_epsilon, half_rmin;  // O, H, H
};

// TIP3P of CHARMM's files: O, H, H.
RigidWater find_water(const ForceField& force_field);

// The dimer of lowest energy is symmetric about the xz plane: the acceptor's hydrogens stand on
// both sides of it, the donor lies in it. That leaves three variables: the distance of the oxygens
// (Å) and the direction of either bisector in the plane, as angles from x (rad).
struct WaterDimer {
    double distance = 0, acceptor = 0, donor = 0;
    double energy = 0;  // kcal/mol
};

// Atoms of a water whose oxygen is at the origin, and of one at that distance along x, Å.
std::vector<Vec3> place_acceptor(const RigidWater& water, double direction);
std::vector<Vec3> place_donor(const RigidWater& water, double distance, double direction);

// Scan of both directions, then Newton's method.
WaterDimer find_lowest_dimer(const RigidWater& water);

}  // namespace palpa
