// The electrostatic potential of charges at a surface.
#pragma once
#include "core/units.h"
#include "math/vec.h"
#include "molecule/surface/mesh.h"

#include <span>
#include <vector>

namespace palpa {

// What is between a charge and a place weakens the potential by this factor. Growing with distance
// it stands for the water that gets between, and charges near by count more: 4 r is a common
// choice. 80 without growth is water everywhere: far away the net charge decides.
struct Dielectric {
    double constant = 4;
    bool grows_with_distance = true;  // times the distance in Å

    friend bool operator==(const Dielectric&, const Dielectric&) = default;
};

struct PotentialSettings {
    Dielectric dielectric{};
    double outward = 1.4;      // Å that a vertex is moved along its normal before, a water's radius
    double temperature = 300;  // K
    double coulomb_constant = units::charmm_coulomb_constant;  // kcal Å/mol/e^2
};

// At every vertex, kT/e. All charges (e) count, whatever their distance; a place closer to one than
// 0.5 Å is as if at 0.5 Å. In single precision, with an error of some 1e-5 of the largest term.
std::vector<float> find_potentials(const SurfaceMesh& mesh, std::span<const Vec3> positions,
                                   std::span<const double> charges,
                                   const PotentialSettings& settings = {});

}  // namespace palpa
