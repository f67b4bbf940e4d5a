// Fast bonded terms: many at a time with the widest vectors of the processor, in double. Its
// reference implementation is forces/bonded.h.
#pragma once
#include "charmm/topology.h"
#include "field/bonded_kernel.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Terms of one kind: their atoms, and their constants in blocks.
template <std::size_t Atoms, class Numbers>
struct TermBlocks {
    std::vector<std::array<std::uint32_t, Atoms>> atoms;
    std::vector<Numbers> blocks;
};

// The bonded terms of one topology; constant after building.
struct FastBonded {
    TermBlocks<2, SpringNumbers> bonds, urey_bradleys;
    TermBlocks<3, AngleNumbers> angles;
    TermBlocks<4, ImproperNumbers> impropers;

    // All multiplicities of four atoms are one term, a sum of cosines and sines.
    struct Series {
        std::vector<Column> cosine, sine;
    };
    TermBlocks<4, Series> dihedrals;  // the shortest series first
    double dihedral_constant = 0;     // kcal/mol, what the series leave out of the energy
};

FastBonded build_fast_bonded(const Topology& topology);

struct BondedEnergy {
    double bond = 0, angle = 0, urey_bradley = 0, dihedral = 0, improper = 0;  // kcal/mol
};

// Adds the forces (kcal/mol/Å, one entry per atom) of all bonds, angles, Urey-Bradley springs,
// dihedrals and impropers. Against the reference: forces within 1e-12 of the larger of the atom's
// own and the rms force, each energy within 1e-12 of its terms' magnitudes. Repeats to the bit on
// the same kind of processor.
BondedEnergy add_fast_bonded_forces(const FastBonded& bonded, std::span<const Vec3> positions,
                                    std::span<Vec3> forces) noexcept;

}  // namespace palpa
