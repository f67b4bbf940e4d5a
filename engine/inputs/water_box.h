// Builds a box of water, with or without a molecule in it.
#pragma once
#include "charmm/force_field.h"
#include "math/vec.h"
#include "molecule/connectivity.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa {

struct WaterBoxSettings {
    std::size_t cells = 3;    // cells of eight waters along each edge, before removal
    double density = 0.0334;  // molecules/Å^3, as water at 300 K
    // Smallest distances of a water's oxygen to the molecule's hydrogens and heavy atoms, Å.
    double closest_hydrogen = 1.8, closest_heavy = 2.6;
    std::uint64_t seed = 1;
};

struct WaterBox {
    Connectivity connectivity;    // the molecule's atoms, then waters in segments WAT, WAT1, ...
    std::vector<Vec3> positions;  // Å, from 0 to edge, except for parts that stick out
    double edge = 0;              // Å
    std::size_t waters = 0;
};

// Waters (CHARMM's TIP3) with their oxygens where cubic ice has them, each turned to where its
// neighbours, periodic images too, let it have the lowest energy of many tries; those that would
// lie on the molecule are left out. At 300 K that melts within picoseconds, and no run begins hot.
// The molecule, which may have no atoms, is moved to the middle of the box. The same call gives the
// same bits. Throws LoadError: no TIP3 among the residues, or no parameters for it or for the
// molecule, or a molecule larger than the box.
WaterBox build_water_box(const ForceField& force_field, const Connectivity& molecule,
                         const std::vector<Vec3>& places, const WaterBoxSettings& settings);

}  // namespace palpa
