// The pairs between what hands hold and the atoms near it, for models that are exact there.
#pragma once
#include "field/cluster_list.h"
#include "field/pair_kernel.h"
#include "statics/torsion_state.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Non-bonded pairs between held atoms and atoms near them, and for whole tiles of the kernel some
// pairs within either set. Pairs that the topology excludes, or that are three bonds apart, are
// left out. Constant but for the kernel's memory.
struct NearPairs {
    ClusterList tiles;  // summed by the kernel
    PairWorkspace workspace;
    SolvationTiles solvation;                          // summed by its own kernel
    std::vector<std::array<std::uint32_t, 2>> others;  // with replaced numbers, summed in double
    // One by one: both, without solvation, and those of its tiles, of which that alone counts.
    std::vector<std::array<std::uint32_t, 2>> all, solvated;
};

// `held`: atoms of all hands, rising. An atom is near if it was within `reach` (Å) of one of them.
NearPairs build_near_pairs(const TorsionModel& model, std::span<const Vec3> positions,
                           std::span<const std::uint32_t> held, double reach);

// Adds their forces (kcal/mol/Å) and returns their energy (kcal/mol). In single precision if the
// settings are fast and no pair is too close for the kernel, else in double.
double add_near_forces(const TorsionModel& model, const ForceSettings& settings, NearPairs& near,
                       std::span<const Vec3> positions, std::span<Vec3> forces);

}  // namespace palpa
