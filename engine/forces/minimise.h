// Downhill from a structure with clashes to one at rest: limited-memory BFGS (J. Nocedal, S. J.
// Wright, Numerical Optimization, 2nd ed., algorithm 7.4), with restraints and fixed atoms.
#pragma once
#include "charmm/topology.h"
#include "forces/force_field.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace palpa {

struct MinimiseSettings {
    // With a cutoff of both energies, pairs are summed over a neighbour list, otherwise over all
    // pairs.
    NonbondedSettings nonbonded;
    double skin = 2;               // Verlet buffer of the list, Å
    std::size_t steps = 500;       // largest number of steps
    double force_tolerance = 0.1;  // the end: rms over the components of free atoms, kcal/mol/Å
    double largest_step = 0.2;     // largest move of an atom in one step, Å
    std::size_t threads = 1;       // threads for sums over a list
};

// Harmonic restraints and fixed atoms. Each span is empty or has one entry per atom.
struct Restraints {
    std::span<const double> k;         // kcal/mol/Å^2, E = k |x - reference|^2; 0 for none
    std::span<const Vec3> references;  // Å, where k is given
    std::span<const std::uint8_t> is_fixed;
};

enum class MinimiseEnd {
    Converged,  // the force tolerance is reached
    Steps,      // the largest number of steps was reached
    Stuck,      // the line search finds no lower energy beyond rounding
};

struct MinimiseReport {
    // With a list: without pairs of two fixed atoms.
    EnergyTerms before, after;
    double restraint_before = 0, restraint_after = 0;  // kcal/mol
    std::size_t steps = 0;                             // number of steps
    std::size_t evaluations = 0;                       // function evaluations
    std::size_t lists = 0;                             // neighbour lists built
    double rms_force = 0;      // at the end, over the components of free atoms, kcal/mol/Å
    double largest_force = 0;  // at the end, on a free atom, kcal/mol/Å
    MinimiseEnd end = MinimiseEnd::Steps;
};

// Moves the free atoms until one of the ends. The energy, restraints included, never rises from
// step to step, and the same call gives the same bits. Positions must be finite. Atoms at one place
// get no force from each other there; others, or the atoms they are bonded to, must part them.
// `on_step` may be empty; it is called at the start, as step 0, and after each step.
MinimiseReport minimise(const Topology& topology, const MinimiseSettings& settings,
                        const Restraints& restraints, std::vector<Vec3>& positions,
                        const std::function<void(std::size_t step, double energy)>& on_step = {});

}  // namespace palpa
