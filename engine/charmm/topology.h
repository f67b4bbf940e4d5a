// The terms of the energy of a set of molecules: bonded terms, charges, Lennard-Jones parameters
// and exclusions. Built once from a structure and a force field; constant after that.
#pragma once
#include "charmm/cmap_map.h"
#include "charmm/solvation.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// Atoms are given by index. Energies follow CHARMM's conventions: no factor one half, angles in
// radian.

// E = k (r - r0)^2
struct Bond {
    std::uint32_t a, b;
    double k;   // kcal/mol/Å^2
    double r0;  // Å
};

// E = k (theta - theta0)^2, theta between a and c as seen from b, 0 to pi.
struct Angle {
    std::uint32_t a, b, c;
    double k;       // kcal/mol/rad^2
    double theta0;  // rad
};

// E = k (s - s0)^2, s between the two ends of an angle.
struct UreyBradley {
    std::uint32_t a, c;
    double k;   // kcal/mol/Å^2
    double s0;  // Å
};

// E = k (1 + cos(n phi - phase)), phi as in forces/torsion.h. A dihedral of several multiplicities
// n is as many entries. n >= 1: what a file gives n = 0 is an Improper here, as it is for CHARMM.
struct Dihedral {
    std::uint32_t a, b, c, d;
    int multiplicity;
    double k;      // kcal/mol
    double phase;  // rad
};

// E = k (psi - psi0)^2, psi the dihedral angle of the four atoms in this order, the order of
// CHARMM's files (the central atom first, as a rule); the difference is taken the short way round.
struct Improper {
    std::uint32_t a, b, c, d;
    double k;     // kcal/mol/rad^2
    double psi0;  // rad
};

// E = map(phi, psi)
struct CmapTerm {
    std::array<std::uint32_t, 4> phi, psi;
    std::uint32_t map;  // in Topology::cmap_maps
};

// Lennard-Jones parameters of one atom type. CHARMM's files have the well depth with a minus.
struct LennardJonesType {
    double epsilon;    // kcal/mol, >= 0
    double half_rmin;  // Å
};

// Lennard-Jones parameters of a pair: E = epsilon [(rmin/r)^12 - 2 (rmin/r)^6]
struct LennardJonesPair {
    double epsilon;  // kcal/mol
    double rmin;     // Å, where the energy is -epsilon
};

// A pair of types, in either order, with explicit parameters in place of combined ones.
struct Nbfix {
    std::uint32_t a, b;
    LennardJonesPair pair;
};

// The parameters of all pairs of types, as a full symmetric matrix.
struct LennardJonesTable {
    std::size_t types = 0;
    std::vector<LennardJonesPair> pairs;

    const LennardJonesPair* row(std::uint32_t type) const noexcept {
        return pairs.data() + type * types;
    }
};

// CHARMM's combination rules, epsilon = (e_i e_j)^(1/2), rmin = half_rmin_i + half_rmin_j, but for
// the pairs in `nbfix`; of two entries for a pair the later one counts. Built once from the plain
// numbers and once from the 1-4 numbers: a type without 1-4 numbers has its plain ones there, and
// so has an NBFIX pair.
LennardJonesTable build_lennard_jones_table(std::span<const LennardJonesType> types,
                                            std::span<const Nbfix> nbfix);

// The pairs that the non-bonded sum leaves out: CHARMM's NBXMOD 5.
struct Exclusions {
    // Atom i leaves out the atoms [first[i], first[i + 1]) of `atoms`: those up to three bonds away
    // with a higher index than its own, rising. One entry more than there are atoms.
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> atoms;
    // Pairs of those that are exactly three bonds apart by the shortest way (in a ring of five none
    // is), which interact by their own Lennard-Jones numbers. Lower index first, rising.
    std::vector<std::array<std::uint32_t, 2>> pairs14;

    std::span<const std::uint32_t> of(std::size_t atom) const noexcept {
        return std::span(atoms).subspan(first[atom], first[atom + 1] - first[atom]);
    }
};

// From the bond graph; a bond given twice counts once.
Exclusions build_exclusions(std::span<const Bond> bonds, std::size_t atom_count);

struct Topology {
    // One entry per atom.
    std::vector<double> charge;       // e
    std::vector<std::uint32_t> type;  // index in the Lennard-Jones tables

    std::vector<Bond> bonds;
    std::vector<Angle> angles;
    std::vector<UreyBradley> urey_bradleys;
    std::vector<Dihedral> dihedrals;
    std::vector<Improper> impropers;
    std::vector<CmapTerm> cmap_terms;
    std::vector<CmapMap> cmap_maps;

    LennardJonesTable lennard_jones;    // pairs other than 1-4
    LennardJonesTable lennard_jones14;  // 1-4 pairs
    Exclusions exclusions;
    std::optional<Solvation> solvation;  // unset in vacuum

    std::size_t size() const noexcept { return charge.size(); }
};

}  // namespace palpa
