// Second derivatives of the energy of one pair of atoms, without or with a cutoff, in double.
#pragma once
#include "charmm/topology.h"
#include "forces/nonbonded.h"
#include "forces/solvation_law.h"

#include <cstdint>

namespace palpa {

// An energy that depends on a distance r alone, as a function of u = r^2/2: dE/du (kcal/mol/Å^2)
// and d2E/du2 (kcal/mol/Å^4). With d the vector between the atoms i and j,
//     d2E/dx_i dx_j = -(first 1 + second d d^T),
// and that of one atom alone is the negative of it.
struct PairHessian {
    double first = 0, second = 0;

    PairHessian& operator+=(const PairHessian& other) noexcept {
        first += other.first;
        second += other.second;
        return *this;
    }
};

// Second derivatives of the functions of forces/pair_law.h, for valid settings.
class PairHessianLaw {
public:
    explicit PairHessianLaw(const NonbondedSettings& settings) noexcept;

    // At the square of a distance (Å^2); `charges` is C q q'/eps. Within `pair_core_radius`
    // the energy is linear in u. Second derivatives jump where switching begins and ends.
    PairHessian evaluate(double r2, double charges, const LennardJonesPair& pair) const noexcept;

    double reach2() const noexcept { return reach2_; }  // Å^2, from where on pairs have nothing

private:
    PairHessian electrostatic(double r2) const noexcept;  // for unit charges
    PairHessian van_der_waals(double r2, const LennardJonesPair& pair) const noexcept;

    ElectrostaticCutoff electrostatics_;
    VanDerWaalsCutoff van_der_waals_;
    bool distance_dielectric_;
    double reach2_;
    double c_, c2_, m2_;  // cutoff and its square, square of where switching begins, Å
};

// The second derivatives of a topology's pairs: of all that forces/nonbonded.h sums of them. Both
// the topology and its solvation must outlive it.
class TopologyPairHessian {
public:
    TopologyPairHessian(const Topology& topology, const NonbondedSettings& settings) noexcept;

    // At the square of the distance of two atoms, Å^2: as a plain pair, and as one three bonds
    // apart.
    PairHessian plain(std::uint32_t i, std::uint32_t j, double r2) const noexcept {
        return evaluate(topology_.lennard_jones, coulomb_, i, j, r2);
    }
    PairHessian three_bonds_apart(std::uint32_t i, std::uint32_t j, double r2) const noexcept {
        return evaluate(topology_.lennard_jones14, coulomb14_, i, j, r2);
    }

    // Solvation only.
    PairHessian solvation(std::uint32_t i, std::uint32_t j, double r2) const noexcept;

    double reach2() const noexcept { return reach2_; }  // Å^2, from where on pairs have nothing

private:
    PairHessian evaluate(const LennardJonesTable& lennard_jones, double coulomb, std::uint32_t i,
                         std::uint32_t j, double r2) const noexcept;

    const Topology& topology_;
    PairHessianLaw law_;
    SolvationLaw<> solvation_;
    double coulomb_, coulomb14_;
    double reach2_;
};

}  // namespace palpa
