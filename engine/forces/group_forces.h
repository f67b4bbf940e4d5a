// The part of a force field that changes when atoms move in rigid groups: terms and pairs between
// different groups.
#pragma once
#include "forces/force_field.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Of one topology, one list of neighbours and one choice of groups; constant but for the kernel's
// memory. Some terms and pairs within a group are in it too, always the same.
struct GroupForces {
    // Bonded terms and 1-4 pairs; without charges, types and exclusions.
    Topology terms;
    FastBonded bonded;  // of terms

    ClusterList tiles;  // pairs for the kernel, without 1-4 pairs
    PairWorkspace workspace;
    SolvationTiles solvation;  // for the solvation kernel, with 1-4 pairs; if tiles are used
    std::vector<std::array<std::uint32_t, 2>> pairs;  // pairs in double, without 1-4 pairs
    bool is_fast = false;                             // computed by kernels, not all in double

    bool was_in_double =
        false;  // the last sum was in double, because pairs were too close for the kernel

    std::vector<std::uint32_t> atoms;  // atoms with forces, ascending
};

// Pairs by the kernel, of those that are listed; `groups` has a number for each atom. Where the
// list ends at a cutoff, only pairs are sure to be there that were `skin` (Å) beyond it or nearer.
GroupForces build_fast_group_forces(const Topology& topology, const FastAtoms& atoms,
                                    const FastPairs& pairs, std::span<const std::uint32_t> groups,
                                    std::span<const Vec3> positions, double skin);

// All pairs in double: those of `list`, or, without a list, all that are not excluded.
GroupForces build_group_forces(const Topology& topology, const PairList* list,
                               std::span<const std::uint32_t> groups);

// Adds forces (kcal/mol/Å) and returns energies (kcal/mol). Reads and writes only entries of
// `GroupForces::atoms`. Pairs that are too close for the kernel are summed in double.
EnergyTerms add_group_forces(const Topology& topology, const NonbondedSettings& settings,
                             GroupForces& group_forces, std::span<const Vec3> positions,
                             std::span<Vec3> forces);

}  // namespace palpa
