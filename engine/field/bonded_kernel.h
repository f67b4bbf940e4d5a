// Springs, angles and torsions in double, many of one kind beside each other, as wide as the
// processor at hand can: the arithmetic of forces/fast_bonded.h. Its reference implementation is
// forces/bonded.h, which says what happens where atoms coincide or stand in line.
#pragma once
#include <array>
#include <cstddef>
#include <span>

namespace palpa {

inline constexpr std::size_t block_size = 64;  // terms

// A number of each term of a block. A block that is not full ends in terms whose constants are
// zero: they have no energy.
struct alignas(64) Column {
    std::array<double, block_size> at{};
};

struct Columns3 {
    Column x, y, z;
};

// E = k (r - r0)^2
struct SpringNumbers {
    Column k, r0;
};

// E = k (theta - theta0)^2
struct AngleNumbers {
    Column k, cos_theta0, sin_theta0;
};

// E = sum over n of cosine[n - 1] cos(n phi) + sine[n - 1] sin(n phi)
struct DihedralNumbers {
    std::span<const Column> cosine, sine;  // as many
};

// E = k (psi - psi0)^2, the short way round
struct ImproperNumbers {
    Column k, cos_psi0, sin_psi0;
};

// Four atoms a, b, c, d, in the letters of forces/torsion.cpp.
struct TorsionBlock {
    Columns3 F, G, H;           // a - b, b - c, d - c, Å
    Columns3 on_F, on_G, on_H;  // -dE/dF and so on: what the kernel finds, kcal/mol/Å
};

// Each returns the energy of a block (kcal/mol) and writes the forces.

// d from b to a, Å.
double evaluate_springs(const SpringNumbers& numbers, const Columns3& d, Columns3& on_a) noexcept;
// u and v from the middle to the ends, Å.
double evaluate_angles(const AngleNumbers& numbers, const Columns3& u, const Columns3& v,
                       Columns3& on_a, Columns3& on_c) noexcept;
double evaluate_dihedrals(const DihedralNumbers& numbers, TorsionBlock& block) noexcept;
double evaluate_impropers(const ImproperNumbers& numbers, TorsionBlock& block) noexcept;

}  // namespace palpa
