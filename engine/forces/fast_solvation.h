// Solvation of a topology in single precision, as fast as the processor at hand can: the pairs of
// forces/solvation.h, those three bonds apart included, by the kernel of field/solvation_kernel.h.
// It has a list of its own, of the atoms that count.
#pragma once
#include "charmm/topology.h"
#include "field/solvation_kernel.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Solvation data of one topology; constant after building, empty without solvation.
struct FastSolvationAtoms {
    std::vector<std::uint32_t>
        atoms;  // atoms with solvation, ascending; what follows is indexed by position in this list
    std::vector<std::uint32_t> number_of;  // for each atom its index in `atoms`, or no_atom
    std::vector<double> volume, strength, inverse_lambda, radius;  // as in `SolvationParameters`
    std::vector<std::array<std::uint32_t, 2>> left_out;

    SolvationParameters parameters() const noexcept {
        return {volume, strength, inverse_lambda, radius};
    }
};

FastSolvationAtoms build_fast_solvation_atoms(const Topology& topology);

// Tiles of pairs by atom numbers, with the memory of the kernel.
struct SolvationTiles {
    ClusterList tiles;
    SolvationWorkspace workspace;
};

// The present neighbour list, by indices of `FastSolvationAtoms`, and the memory of the kernel.
struct FastSolvationPairs {
    ClusterList list;
    SolvationWorkspace workspace;
    std::size_t builds = 0;
    std::vector<Vec3> positions, forces;  // for the atoms with solvation, Å and kcal/mol/Å
    // See `FastPairs`.
    SolvationTiles near;
    std::vector<Vec3> selected, summed;
};

// Adds forces (kcal/mol/Å, one entry per atom) and returns the energy (kcal/mol) of all pairs, with
// the smooth end. `pairs` is updated where it is outdated, with `skin` (Å). In double where two
// atoms are as close or as far apart as field/pair_kernel.h says.
double add_fast_solvation_forces(const Topology& topology, const FastSolvationAtoms& atoms,
                                 double skin, std::span<const Vec3> positions,
                                 FastSolvationPairs& pairs, std::span<Vec3> forces,
                                 std::size_t threads = 1);

// The same for tiles that are still valid.
double add_solvation_tiles(const Topology& topology, SolvationTiles& tiles,
                           std::span<const Vec3> positions, std::span<Vec3> forces,
                           std::size_t threads = 1);

// The pairs of `pairs` between atoms of different `groups` (one number per atom) that are within
// `skin` of acting on each other, and some others; as select_tiles.
SolvationTiles select_solvation_tiles(const FastSolvationAtoms& atoms,
                                      const FastSolvationPairs& pairs,
                                      std::span<const std::uint32_t> groups,
                                      std::span<const Vec3> positions, double skin);

// All pairs of some atoms (of which those that do not count are passed over), but for those that
// `left_out` names and tiles within one of `groups`, which has a number for each of `among`.
SolvationTiles build_solvation_tiles(const FastSolvationAtoms& atoms,
                                     std::span<const std::uint32_t> among,
                                     std::span<const std::uint32_t> groups,
                                     std::span<const std::array<std::uint32_t, 2>> left_out,
                                     const Vec3& origin);

}  // namespace palpa
