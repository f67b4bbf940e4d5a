// The work of one thread in a solvation sum over a cluster list (field/solvation_kernel.h),
// compiled for each instruction set.
#pragma once
#include "field/solvation_kernel.h"

#include <cstddef>
#include <limits>

namespace palpa {

// Clusters [first, last) of a list, those of one thread.
struct SolvationJob {
    const ClusterList* list;
    const SolvationCluster* atoms;
    ClusterForces* forces;
    std::size_t first, last;
    double begin, end;  // range of the switching function, Å
};

struct SolvationJobSum {
    double energy = 0;
    float nearest2 = std::numeric_limits<float>::infinity();  // Å^2
};

// Adds to the forces of the clusters and returns the energy, on the processor at hand.
SolvationJobSum run_solvation_job(const SolvationJob& job);

}  // namespace palpa
