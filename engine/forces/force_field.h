// The complete force field of a topology: energy term by term, and the force on every atom.
#pragma once
#include "charmm/topology.h"
#include "forces/fast_bonded.h"
#include "forces/fast_nonbonded.h"
#include "forces/nonbonded.h"
#include "forces/pair_list.h"
#include "math/vec.h"

#include <cstddef>
#include <span>

namespace palpa {

// In kcal/mol.
struct EnergyTerms {
    double bond = 0;
    double angle = 0;
    double urey_bradley = 0;
    double dihedral = 0;
    double improper = 0;
    double cmap = 0;
    double lj = 0;         // pairs other than 1-4
    double lj14 = 0;       // pairs three bonds apart
    double coulomb = 0;    // pairs other than 1-4
    double coulomb14 = 0;  // pairs three bonds apart
    double solvation = 0;  // pairs of both kinds, and what each atom has alone

    double total() const noexcept {
        return bond + angle + urey_bradley + dihedral + improper + cmap + lj + lj14 + coulomb +
               coulomb14 + solvation;
    }
    double magnitude() const noexcept;  // sum of the absolute terms
    EnergyTerms& operator+=(const EnergyTerms& other) noexcept;
    EnergyTerms& operator-=(const EnergyTerms& other) noexcept;
};

// Adds all forces (kcal/mol/Å) to `forces`, one entry per atom, in a fixed order: a repeated call
// gives the same bits. Finite wherever the atoms are; each term says in its header how.
EnergyTerms add_forces(const Topology& topology, const NonbondedSettings& settings,
                       std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

// The same with the pairs of a list (forces/nonbonded.h says which). Shared among `threads`, at
// least 1: a call repeats to the bit with the same list and the same number of threads. More than
// one take memory of their own and start anew at each call; std::system_error where there are none.
EnergyTerms add_forces(const Topology& topology, const NonbondedSettings& settings,
                       const PairList& list, std::span<const Vec3> positions,
                       std::span<Vec3> forces, std::size_t threads = 1);

// Data of the fast force field of a topology; constant after building.
struct FastForceField {
    FastAtoms atoms;
    FastBonded bonded;
};

FastForceField build_fast_force_field(const Topology& topology);

// All terms but the plain pairs and what atoms have alone, in double: those of `bonded`, which are
// of `terms`, its maps and its pairs three bonds apart. `topology` has the charges, types and maps.
EnergyTerms add_fast_terms(const Topology& topology, const Topology& terms,
                           const FastBonded& bonded, const NonbondedSettings& settings,
                           std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

// The fast version: pairs as in `add_fast_nonbonded_forces`, other terms in double. Energies of
// non-1-4 pairs only on request.
EnergyTerms add_fast_forces(const Topology& topology, const FastForceField& fast,
                            const NonbondedSettings& settings, double skin,
                            std::span<const Vec3> positions, FastPairs& pairs,
                            std::span<Vec3> forces, PairResult result, std::size_t threads = 1);

}  // namespace palpa
