// The fast non-bonded sum of a topology in single precision: the pairs of forces/nonbonded.h by the
// kernel of field/pair_kernel.h.
#pragma once
#include "charmm/topology.h"
#include "field/pair_kernel.h"
#include "forces/fast_solvation.h"
#include "forces/nonbonded.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// Atom data of one topology; constant after building.
struct FastAtoms {
    std::vector<double> sqrt_epsilon, half_rmin;  // per atom, as in `PairParameters`
    // Pairs that the kernel leaves out: those that the topology excludes, then those whose numbers
    // are not combined from the two types' own (NBFIX), from `first_replaced` on.
    std::vector<std::array<std::uint32_t, 2>> left_out;
    std::size_t first_replaced = 0;
    // Empty, or a number for each atom: of pairs with one number some are left out of the sum over
    // all pairs, always the same. Their energy is constant and their forces are no one's concern.
    // Sums that end at a cutoff have all near pairs, since there clusters change. The caller's to
    // write.
    std::vector<std::uint32_t> groups;
    FastSolvationAtoms solvation;

    std::span<const std::array<std::uint32_t, 2>> excluded() const noexcept {
        return std::span(left_out).first(first_replaced);
    }
    std::span<const std::array<std::uint32_t, 2>> replaced() const noexcept {
        return std::span(left_out).subspan(first_replaced);
    }
};

FastAtoms build_fast_atoms(const Topology& topology);

// The settings as kernels take them, with those of solvation where its end is smooth.
PairScheme pair_scheme(const NonbondedSettings& settings) noexcept;

// Whether they have kernels in single precision (field/pair_kernel.h): not the sharp end of
// solvation, and of cutoffs those that scenes use.
bool has_fast_form(const NonbondedSettings& settings) noexcept;

// The present neighbour list and the memory of the kernel; the settings decide whether it contains
// all pairs.
struct FastPairs {
    ClusterList list;
    PairWorkspace workspace;
    // What the list leaves out, as in `FastAtoms`; where it ends at a cutoff, of the pairs with
    // replaced numbers only those that may come that near before it is built anew.
    std::vector<std::array<std::uint32_t, 2>> left_out;
    std::size_t first_replaced = 0;
    std::vector<std::array<std::uint32_t, 2>> replaced;  // of these, those that are near now
    std::vector<Vec3> positions;                         // Å, when it was built
    std::size_t builds = 0, updates = 0;                 // of the list so far
    // The tiles that are near now, of a list with a cutoff, for atoms that move little between
    // sums.
    struct NearTiles {
        ClusterList tiles;
        PairWorkspace workspace;
        std::vector<Vec3> selected;  // positions when they were found, Å; empty: there are none
    } near;
    std::vector<Vec3> summed;   // positions of the last sum, Å
    std::size_t in_double = 0;  // sums so far that single precision did not do
    FastSolvationPairs solvation;
};

// Adds the forces (kcal/mol/Å) of all pairs but those three bonds apart, as `add_nonbonded_forces`
// does, and returns their energies, zero unless asked for. Where the settings have a fast form, the
// solvation of those three bonds apart is in it. Settings must be sound. A list with a
// cutoff holds pairs up to `skin` (Å) beyond it; `pairs`, empty before the first call and of one
// topology and cutoff ever after, is updated when outdated. Pairs with replaced numbers are
// summed in double. So is everything where single precision does not do: settings without a
// fast form; atoms as close or as far apart as field/pair_kernel.h says.
NonbondedEnergy add_fast_nonbonded_forces(const Topology& topology, const FastAtoms& atoms,
                                          const NonbondedSettings& settings, double skin,
                                          std::span<const Vec3> positions, FastPairs& pairs,
                                          std::span<Vec3> forces, PairResult result,
                                          const PairThreads& threads = {});

// The same for the pairs of one valid list, with its own workspace, and for other pairs, which are
// summed in double; without solvation. Atoms in neither are ignored. Returns nothing and adds no
// forces if single precision is not sufficient.
std::optional<NonbondedEnergy> add_tile_forces(const Topology& topology,
                                               const NonbondedSettings& settings,
                                               const ClusterList& list, PairWorkspace& workspace,
                                               std::span<const std::array<std::uint32_t, 2>> others,
                                               std::span<const Vec3> positions,
                                               std::span<Vec3> forces, PairResult result,
                                               const PairThreads& threads = {});

// The same pairs in double, with solvation if the settings have it, so that energies can be
// compared with those of other positions.
NonbondedEnergy add_pairs_in_double(const Topology& topology, const NonbondedSettings& settings,
                                    const ClusterList& list,
                                    std::span<const std::array<std::uint32_t, 2>> others,
                                    std::span<const Vec3> positions, std::span<Vec3> forces);

}  // namespace palpa
