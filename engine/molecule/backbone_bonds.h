// Finds backbone hydrogen bonds (N-H to O=C) of proteins by an electrostatic energy.
#pragma once
#include "molecule/secondary_structure.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace palpa {

// The two strongest bonds of each N-H, as DSSP keeps them.
class BackboneBonds {
public:
    explicit BackboneBonds(std::span<const BackboneResidue> residues);

    // Whether the N-H of one residue is bonded to the O=C of the other; false if one is missing.
    bool has(std::ptrdiff_t donor, std::ptrdiff_t acceptor) const noexcept;

    // The acceptors of a residue's N-H, the strongest first.
    std::span<const std::ptrdiff_t> acceptors(std::ptrdiff_t donor) const noexcept;

private:
    struct Donor {
        std::array<std::ptrdiff_t, 2> acceptors{};
        std::array<double, 2> energies{};  // kcal/mol
        std::size_t count = 0;
    };
    void add(std::size_t donor, std::size_t acceptor, double energy);

    std::vector<Donor> donors_;
};

// Between an N-H and an O=C, kcal/mol: 27.9 (1/r_ON + 1/r_CH - 1/r_OH - 1/r_CN), and -9.9 where two
// of these are closer than 0.5 Å or the sum is lower.
double backbone_bond_energy(const Vec3& n, const Vec3& h, const Vec3& c, const Vec3& o) noexcept;

}  // namespace palpa
