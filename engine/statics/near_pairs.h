// Pairs between held atoms and atoms near them, for models that are exact there.
#pragma once
#include "field/cluster_list.h"
#include "field/pair_kernel.h"
#include "statics/torsion_state.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Non-bonded pairs between held atoms and atoms near them; to fill whole tiles of the kernel also
// some pairs within either set. Excluded pairs and 1-4 pairs are not included. Constant except for
// the kernel's memory.
struct NearPairs {
    ClusterList tiles;  // summed by the kernel
    PairWorkspace workspace;
    SolvationTiles solvation;  // summed by its own kernel
    std::vector<std::array<std::uint32_t, 2>>
        others;  // pairs with replaced parameters, summed in double
    // As lists of pairs: the pairs of `tiles` and `others` without solvation, and the pairs of
    // `solvation`, of which only the solvation part is meant.
    std::vector<std::array<std::uint32_t, 2>> all, solvated;
};

// `held`: atoms of all hands, ascending. An atom is near if it is within `reach` (Å) of one of
// them.
NearPairs build_near_pairs(const TorsionModel& model, std::span<const Vec3> positions,
                           std::span<const std::uint32_t> held, double reach);

// Adds their forces (kcal/mol/Å) and returns their energy (kcal/mol). In single precision if the
// settings are fast and no pair is too close for the kernel, else in double.
double add_near_forces(const TorsionModel& model, const ForceSettings& settings, NearPairs& near,
                       std::span<const Vec3> positions, std::span<Vec3> forces);

}  // namespace palpa
