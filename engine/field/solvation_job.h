// What one thread does of a sum of solvation over a list of clusters (field/solvation_kernel.h), by
// code that is compiled for each kind of processor.
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
    double begin, end;  // of the switch, Å
};

struct SolvationJobSum {
    double energy = 0;
    float nearest2 = std::numeric_limits<float>::infinity();  // Å^2
};

// Adds to the forces of the clusters and returns the energy, on the processor at hand.
SolvationJobSum run_solvation_job(const SolvationJob& job);

}  // namespace palpa
