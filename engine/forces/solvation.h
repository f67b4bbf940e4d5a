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

// From where on pairs have none, Å; 0 for None.
double find_solvation_reach(SolvationEnd end) noexcept;

// The sum of dG_ref, kcal/mol: what the atoms have where all are alone. 0 for None.
double find_lone_solvation(const Topology& topology, SolvationEnd end) noexcept;

// All below add forces (kcal/mol/Å, one entry per atom) and return the pairs' energy (kcal/mol).
// The topology must have the numbers. Within `pair_core_radius` (field/pair_field.h) a pair is
// continued as a parabola, so that atoms at one place give a finite energy and no force.

// Every plain pair.
double add_solvation_forces(const Topology& topology, SolvationEnd end,
                            std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

// The plain pairs of some rows of a list that is not outdated and goes as far at least.
double add_solvation_forces(const Topology& topology, SolvationEnd end, const PairList& list,
                            PairRows rows, std::span<const Vec3> positions,
                            std::span<Vec3> forces) noexcept;

// Only the pairs given.
double add_solvation_forces(const Topology& topology, SolvationEnd end,
                            std::span<const std::array<std::uint32_t, 2>> pairs,
                            std::span<const Vec3> positions, std::span<Vec3> forces) noexcept;

enum class SolvationExponential {
    Exact,
    // As in CHARMM before October 2013: x = |r - R_i|/lambda_i in steps of 0.01, at their middle,
    // rounded to five decimals, and 0 from 3.5 on.
    Table,
};

// Of each atom, kcal/mol: dG_ref less what the others take, pairs three bonds apart included. Their
// sum is the whole energy.
std::vector<double> find_solvation_energies(
    const Topology& topology, SolvationEnd end, std::span<const Vec3> positions,
    SolvationExponential exponential = SolvationExponential::Exact);

}  // namespace palpa
