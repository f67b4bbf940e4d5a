// The single-precision kernel for EEF1's solvation energy over a cluster list, with the widest
// vectors of the processor. Its reference implementation in double is forces/solvation.h.
#pragma once
#include "field/pair_kernel.h"
#include "field/solvation_parameters.h"

#include <array>
#include <span>
#include <vector>

namespace palpa {

// The atoms of a cluster as the kernel wants them; a coordinate is high + low as in `ClusterAtoms`.
struct alignas(64) SolvationCluster {
    using Column = ClusterAtoms::Column;

    std::array<Column, 3> high, low;  // Å, from the origin
    Column volume, strength;
    // x (log2 e)^(1/2) = r scale - offset: the exponential is a power of 2.
    Column scale, offset;
};

// As `PairWorkspace`; made by `build_solvation_workspace` for one list.
struct SolvationWorkspace {
    Vec3 origin = Vec3::Zero();
    std::vector<SolvationCluster> atoms;
    std::vector<std::vector<ClusterForces>> forces;
};

SolvationWorkspace build_solvation_workspace(const ClusterList& list,
                                             const SolvationParameters& parameters,
                                             SolvationWorkspace storage = {});

struct SolvationKernelSum {
    bool is_sound = false;  // as in `PairKernelSum`
    double energy = 0;      // kcal/mol
};

// Adds the forces (kcal/mol/Å, one entry per atom of the list) of all pairs of a list that is not
// outdated and goes to `end` (Å) at least: there is nothing from there on, and before it a switch
// that is smooth to the second derivative from `begin` on. Precision, and what repeats, as of
// `add_cluster_pair_forces`.
SolvationKernelSum add_cluster_solvation_forces(const ClusterList& list, double begin, double end,
                                                std::span<const Vec3> positions,
                                                SolvationWorkspace& workspace,
                                                std::span<Vec3> forces,
                                                const PairThreads& threads = {});

}  // namespace palpa
