// A CMAP map: a correction energy over two dihedral angles, as a smooth periodic surface.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace palpa {

// The surface at one point of the grid; slopes are per step of the grid, all in kcal/mol.
struct CmapPoint {
    double energy, slope_phi, slope_psi, twist;  // twist = d2E / (dphi dpsi)
};

// `size` x `size` points from -180 degrees upwards in steps of 360/size, psi running fastest.
// Between four points the surface is the bicubic polynomial that has their energies, slopes and
// twists.
struct CmapMap {
    std::size_t size = 0;
    std::vector<CmapPoint> points;
};

// From energies in CHARMM's order (first angle slowest, both from -180 degrees; 24 x 24 in its
// files), kcal/mol; a square number of them. Slopes and twists are those of periodic cubic splines
// along the rows and columns. CHARMM splines a map that is continued by half a period at either
// side, with natural ends, instead: what those ends do has fallen by 2 - sqrt(3) per point, to
// 1e-7, when it reaches the map. Source: A. D. MacKerell, M. Feig, C. L. Brooks, J. Comput. Chem.
// 25, 1400 (2004).
CmapMap build_cmap_map(std::span<const double> energies);

}  // namespace palpa
