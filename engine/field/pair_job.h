// What one thread does of a sum over a list of clusters (field/pair_kernel.h), by code that is
// compiled for each kind of processor.
#pragma once
#include "field/pair_kernel.h"

#include <cstddef>
#include <limits>

namespace palpa {

// Clusters [begin, end) of a list, those of one thread.
struct PairJob {
    const ClusterList* list;
    const PairScheme* scheme;
    const ClusterAtoms* atoms;
    ClusterForces* forces;
    std::size_t begin, end;
    bool with_energies;
};

struct JobSum {
    double van_der_waals = 0, electrostatic = 0;
    float nearest2 = std::numeric_limits<float>::infinity();  // Å^2
};

// Adds to the forces of the clusters and returns the energies, on the processor at hand.
JobSum run_pair_job(const PairJob& job);

}  // namespace palpa
