// The work of one thread in a sum over a cluster list (field/pair_kernel.h), compiled for each
// instruction set.
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
