// Energies and forces of CMAP terms: a surface over two dihedral angles.
#pragma once
#include "charmm/topology.h"
#include "math/vec.h"

#include <span>

namespace palpa {

struct CmapValue {
    double energy;                // kcal/mol
    double slope_phi, slope_psi;  // kcal/mol/rad
};

// The surface at two angles (rad, -pi to pi). Its slopes are continuous everywhere, across the
// edges of the map too.
CmapValue evaluate_cmap(const CmapMap& map, double phi, double psi) noexcept;

// Adds the forces of the terms (kcal/mol/Å) to `forces`, one entry per atom, and returns their
// energy (kcal/mol), summed in the order of the terms. For three atoms in line see
// forces/torsion.h.
double add_cmap_forces(std::span<const CmapTerm> terms, std::span<const CmapMap> maps,
                       std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

}  // namespace palpa
