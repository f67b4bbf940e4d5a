// What one thread of field/pair_kernel.cpp is asked for, by the part of it that is compiled once of
// the parts that are compiled for each kind of processor.
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

}  // namespace palpa
