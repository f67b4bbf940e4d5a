// Molecules made up for tests of the assembly tree: right lengths and angles of bonds, atoms that
// may lie on each other, and a random choice of what turns.
#pragma once
#include "assembly/bodies.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace palpa::test {

struct TorsionCase {
    TorsionBodies bodies;
    std::vector<double> masses;
    std::vector<Vec3> positions, forces;
};

enum class TorsionShape { Tree, Chain, Comb, Star };

class TorsionCaseBuilder {
public:
    explicit TorsionCaseBuilder(std::uint32_t seed) : random_(seed) {}

    // A molecule of `bodies` rigid bodies of one to eight atoms. Of a star all but one hang on one.
    void add_molecule(std::size_t bodies, TorsionShape shape = TorsionShape::Tree);

    TorsionCase take() { return std::move(case_); }

private:
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    std::size_t below(std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
    }

    // Counted from the base.
    std::uint32_t parent_of(std::uint32_t body, TorsionShape shape);
    std::uint32_t add_atom(std::uint32_t body, const Vec3& position);
    // In a direction that makes some angle with the other bonds of the atom, if there are few.
    std::uint32_t add_bonded(std::uint32_t to, std::uint32_t body);
    void add_body_atoms(std::uint32_t first, std::uint32_t body, std::size_t least);
    // With fewer than four bonds.
    std::uint32_t any_atom_of(std::uint32_t body);

    std::mt19937 random_;
    TorsionCase case_;
    std::vector<std::vector<std::uint32_t>> atoms_of_, bonded_;
};

TorsionCase torsion_case(std::uint32_t seed, std::size_t bodies, TorsionShape shape);

}  // namespace palpa::test
