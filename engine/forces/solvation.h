// EEF1's solvation of a topology in double (T. Lazaridis, M. Karplus, Proteins 35, 133 (1999)):
//   G = sum of dG_ref - sum over pairs of [c_ij g_i(r) + c_ji g_j(r)],
//   c_ij = dG_free_i V_j/(2 pi^(3/2) lambda_i), g_i = exp(-((r - R_i)/lambda_i)^2)/r^2
// Pairs are the plain ones and those three bonds apart, and all end as `SolvationEnd` says.
// forces/nonbonded.h adds them to other pairs.
#pragma once
#include "charmm/topology.h"
#include "field/cutoff.h"
#include "forces/pair_list.h"
#include "math/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Distance beyond which pairs have no solvation, Å; 0 for None.
double find_solvation_reach(SolvationEnd end) noexcept;

// The sum of dG_ref, the energy of separated atoms, kcal/mol. 0 for None.
double find_lone_solvation(const Topology& topology, SolvationEnd end) noexcept;

// All below add forces (kcal/mol/Å, one entry per atom) and return the pairs' energy (kcal/mol).
// The topology must have the numbers. Within `pair_core_radius` (field/pair_field.h) a pair is
// continued as a parabola, so that atoms at one place give a finite energy and no force.

// All pairs that are not excluded, without 1-4 pairs.
double add_solvation_forces(const Topology& topology, SolvationEnd end,
                            std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

// The pairs of some rows of a valid list with at least this range.
double add_solvation_forces(const Topology& topology, SolvationEnd end, const PairList& list,
                            PairRows rows, std::span<const Vec3> positions,
                            std::span<Vec3> forces) noexcept;

// Only these pairs.
double add_solvation_forces(const Topology& topology, SolvationEnd end,
                            std::span<const std::array<std::uint32_t, 2>> pairs,
                            std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

enum class SolvationExponential {
    Exact,
    // As in CHARMM before October 2013: x = |r - R_i|/lambda_i in steps of 0.01, at their middle,
    // rounded to five decimals, and 0 from 3.5 on.
    Table,
};

// For each atom, kcal/mol: dG_ref minus what its neighbours take, 1-4 pairs included. The sum is
// the total energy.
std::vector<double> find_solvation_energies(
    const Topology& topology, SolvationEnd end, std::span<const Vec3> positions,
    SolvationExponential exponential = SolvationExponential::Exact);

}  // namespace palpa
