// Measures between atoms: distances, angles, clashes, salt bridges.
#pragma once
#include "molecule/atoms.h"

#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// The angle at b between a and c, rad, 0 to pi; 0 if two points coincide.
double find_angle(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

// About the line from b to c, by the right-hand rule as IUPAC has it, rad, -pi to pi: positive
// where, looking from b to c, d is clockwise from a. 0 where three are in line.
double find_dihedral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

// Two atoms of a table.
struct AtomPair {
    std::uint32_t a = 0, b = 0;
    double distance = 0;  // Å
};

// By how much van der Waals spheres overlap (Å) in a serious clash (J. M. Word et al., J. Mol.
// Biol. 1999, 285, 1711), and at least in a contact (UCSF Chimera: 0.4 Å are between them).
inline constexpr double clash_overlap = 0.4, contact_overlap = -0.4;

// Pairs a < b of heavy atoms of two residues that are nearer than the sum of their radii
// (van_der_waals_radius) less the overlap, and more than three bonds apart; by rising a, then b.
// Atoms of elements without a radius take no part. `residues`: list_residues. `of`, one an atom:
// only pairs of one of these with one that is not; empty: all.
std::vector<AtomPair> find_overlaps(const AtomTable& atoms, std::span<const AtomRange> residues,
                                    double overlap = clash_overlap,
                                    const std::vector<bool>& of = {});

// Salt bridges: a nitrogen (a) of Lys, Arg or doubly protonated His at most `distance` (Å) from an
// oxygen (b) of Asp or Glu (D. J. Barlow and J. M. Thornton, J. Mol. Biol. 1983, 168, 867). The
// nearest atoms of each two residues, by rising a, then b. Residues without hydrogens have their
// usual charge; histidine then has it as HSP or HIP alone.
std::vector<AtomPair> find_salt_bridges(const AtomTable& atoms, std::span<const AtomRange> residues,
                                        double distance = 4);

}  // namespace palpa
